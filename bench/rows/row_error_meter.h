// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>

#include "measure/converged.h"
#include "rows/row_solver.h"

namespace cairn::cli {

/// How far a state of a frame is from the solution.
struct RowError {
  double residual = 0;         ///< Natural, largest row that acts on points [m/s].
  double residual_energy = 0;  ///< Of all rows [sqrt(J)].
  double velocity = 0;         ///< Largest difference of a centre of mass to the reference [m/s].
  double velocity_rms = 0;     ///< Of all momenta, see bench::VelocityDistance [m/s].
};

/// Measures states of one frame, against a converged reference if there is one.
class RowErrorMeter {
 public:
  enum class Reference {
    kNone,  ///< Residuals alone.
    kFind,  ///< Sweeps with subspace steps in double precision, which may take seconds.
  };
  RowErrorMeter(const RowProblem& problem, Reference reference);

  /// NaN for velocities if there is no reference.
  RowError Measure(const RowOutcome& outcome) const;
  RowError MeasureStart() const;

  /// None if it was not asked for, or a frame is refused.
  const std::optional<bench::Converged>& reference() const { return reference_; }

 private:
  const RowProblem& problem_;
  bench::VelocityNorm norm_;
  std::optional<bench::Converged> reference_;
};

}  // namespace cairn::cli
