// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "measure/contact_frame.h"
#include "measure/velocity_norm.h"

namespace cairn::bench {

/// A solution that errors are measured against, and how good it is itself.
struct Converged {
  std::vector<Velocity> velocities;  ///< One per body of the problem.
  double residual_max = 0;           ///< By cairn::Measure(), translational [m/s].
  double residual_energy = 0;        ///< [sqrt(J)]
  int sweeps = 0, factorisations = 0;
  bool reached = false;  ///< residual_max <= kConvergedTo.
  /// To the solution that is found from impulses of 0: errors that are not much larger than this
  /// tell solvers apart no more. Rows with friction may have several solutions; rows that
  /// contradict each other have none, but velocities still settle.
  VelocityDistance spread;
};

inline constexpr double kConvergedTo = 1e-8;  ///< [m/s]

/// What a reference may cost, from either start: relaxations of rows, 1e8 take about a second.
inline constexpr double kReferenceWork = 2e8;

/// Sweeps with subspace steps in double precision until kConvergedTo, or as far as they go.
/// @param work  relaxations of rows at most, from either start
/// @throws std::runtime_error if the problem is refused
Converged Converge(const ContactFrame& frame, const VelocityNorm& norm,
                   double work = kReferenceWork);

}  // namespace cairn::bench
