// SPDX-License-Identifier: MIT
#pragma once

#include <ctime>
#include <span>
#include <vector>

namespace cairn::cli {

/// The clock that solvers are timed with.
enum class SolverClock {
  kThreadCpu,  ///< CPU time of this thread: other programs do not count.
  kWall,       ///< For solvers with more than one thread.
};

/// [ms], from any fixed point on. In the header: libraries below this one use it, too.
inline double Now(SolverClock clock) {
  timespec time{};
  clock_gettime(clock == SolverClock::kThreadCpu ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC,
                &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

/// Runs from its construction on.
class Stopwatch {
 public:
  explicit Stopwatch(SolverClock clock) : clock_(clock) {}
  double Read() const { return Now(clock_) - start_; }  ///< [ms]

 private:
  SolverClock clock_;
  double start_ = Now(clock_);
};

/// Adds the time of its life to a sum [ms].
class SummedTime {
 public:
  SummedTime(SolverClock clock, double* sum) : stopwatch_(clock), sum_(sum) {}
  ~SummedTime() { *sum_ += stopwatch_.Read(); }
  SummedTime(const SummedTime&) = delete;
  SummedTime& operator=(const SummedTime&) = delete;

 private:
  Stopwatch stopwatch_;
  double* sum_;
};

/// What something took the thread that did it.
struct ThreadTime {
  double cpu = 0, wall = 0;  ///< [ms]
  bool preempted = false;    ///< It was taken off its core meanwhile.
};

/// Likewise, with both clocks, and whether the thread kept its core.
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
