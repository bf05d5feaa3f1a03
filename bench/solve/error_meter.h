// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "problems/problem.h"

namespace cairn::cli {

/// Measures how far an x is from the solution of a problem.
class ErrorMeter {
 public:
  /// What iterates are compared with.
  enum class Truth {
    kNone,       ///< Nothing: there are no errors.
    kSolution,   ///< The known solution.
    kSlack,      ///< The known w: x may not be unique.
    kBestFound,  ///< The best that was found here: by interior points, else by sweeps and steps.
    kConverged,  ///< Of a recorded frame: velocities of a solution that converged.
  };

  /// Compares with nothing.
  ErrorMeter() = default;
  /// With what is known; where nothing is, finds it, which may take as long as the solvers do.
  explicit ErrorMeter(const problems::Problem& problem);

  Truth truth() const { return truth_; }
  /// LcpResidual::relative of what was found; NaN otherwise.
  double best_residual() const { return best_residual_; }
  /// "x", "w" or "best": for the table.
  const char* name() const;

  /// |x - x*|_2 / |x*|_2, or |w - w*|_2 / |q|_2; not relative where the divisor is 0. NaN for
  /// kNone.
  double Error(const BoxedLcp& lcp, const Eigen::VectorXd& x) const;
  /// The same in the norm x' M x; NaN unless x itself is compared.
  double EnergyError(const BoxedLcp& lcp, const Eigen::VectorXd& x) const;

 private:
  Truth truth_ = Truth::kNone;
  Eigen::VectorXd target_;  ///< x* or w*
  double scale_ = 1, energy_scale_ = 1;
  double best_residual_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace cairn::cli
