// SPDX-License-Identifier: MIT
#pragma once

namespace cairn::cli {

/// The clock that solvers are timed with.
enum class SolverClock {
  kThreadCpu,  ///< CPU time of this thread: other programs do not count.
  kWall,       ///< For solvers with more than one thread.
};

/// [ms], from any fixed point on.
double Now(SolverClock clock);

}  // namespace cairn::cli
