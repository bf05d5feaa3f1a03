// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

namespace cairn::cli {

/// The clock that solvers are timed with.
enum class SolverClock {
  kThreadCpu,  ///< CPU time of this thread: other programs do not count.
  kWall,       ///< For solvers with more than one thread.
};

/// [ms], from any fixed point on.
double Now(SolverClock clock);

/// What something took the thread that did it.
struct ThreadTime {
  double cpu = 0, wall = 0;  ///< [ms]
  bool preempted = false;    ///< It was taken off its core meanwhile.
};

/// Runs from its construction on.
class ThreadStopwatch {
 public:
  ThreadTime Read() const;

 private:
  static ThreadTime Now();
  static long Preemptions();

  long preemptions_ = Preemptions();
  ThreadTime start_ = Now();
};

/// Those of the values in whose time the thread kept its core; all, if that is fewer than a
/// quarter.
/// @pre one flag for each value
std::vector<double> Undisturbed(std::span<const double> values, const std::vector<bool>& preempted);

}  // namespace cairn::cli
