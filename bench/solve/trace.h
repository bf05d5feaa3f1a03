// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "cairn/solver.h"
#include "solve/solve_result.h"

namespace cairn::cli {

/// Watches a solver: error over time, as an Observer. The time it takes for that is left out.
///
/// The error of every iterate is measured, so that the first with a given error is found exactly;
/// of the rest, the history keeps the first hundred and then so many that they are 1 % apart.
class Trace {
 public:
  struct Setup {
    const BoxedLcp& lcp;
    const ErrorMeter& meter;
    SolverClock clock;
    std::optional<double> budget;  ///< Time after which the solver is told to end [ms].
    /// Called with every iterate, to show progress. May be empty.
    std::function<void(const lcp::Iterate&)> show;
  };
  Trace(Setup setup, std::span<const double> levels);

  /// The clock starts now.
  /// @param time  spent before, on coarser grids [ms]
  void Begin(const Eigen::VectorXd& start, double time);
  /// False once the budget is spent.
  bool Look(const lcp::Iterate& iterate);
  /// Adds what the solver returned, which need not be its last iterate.
  void End(const LcpOutcome& outcome);

  std::vector<LevelReached> TakeLevels() { return std::move(levels_); }
  std::vector<HistoryPoint> TakeHistory() { return std::move(history_); }

 private:
  enum class Keep { kIfDue, kAlways };
  void Record(const lcp::Iterate& iterate, double time, Keep keep);
  /// The history ends with the same iterate.
  bool IsLast(const HistoryPoint& point) const;

  Setup setup_;
  std::vector<LevelReached> levels_;
  std::vector<HistoryPoint> history_;
  long long count_ = 0, next_ = 0;
  double begin_ = 0, spent_ = 0;  ///< [ms] of the clock; time of looking
};

}  // namespace cairn::cli
