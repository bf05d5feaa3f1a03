// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "lcp/lcp_solvers.h"
#include "problems/problem.h"
#include "solve/solve_options.h"
#include "solve/solve_result.h"

namespace cairn::cli {

/// One solver on one problem or march.
class PairRun {
 public:
  PairRun(const SolveOptions& options, const LcpSolverEntry& entry, SolverClock clock);

  /// Takes the history of a single problem.
  /// @param show  is called with every iterate, for progress
  void Watch(const problems::Problem& problem, const ErrorMeter& meter,
             const std::function<void(const lcp::Iterate&)>& show);

  /// Solves from the first problem to the last. The time of each repetition is kept, and the rest
  /// of the last one.
  /// @param show  is called with the number of each problem before it is solved
  void Solve(problems::Source* source, const std::function<void(int)>& show);

  /// @param lcp  what the meter is for
  LcpSolverResult Finish(const BoxedLcp& lcp, const ErrorMeter& meter);

 private:
  /// @return time [ms]
  double SolveStep(const problems::Problem& problem, int steps, int step);
  /// Adds what was done on one problem to the sums.
  void Add(const LcpOutcome& outcome);
  /// Empty if it is solved.
  std::string WhyNotSolved(const LcpOutcome& outcome, double residual) const;
  void AddMarchPoint(double time);
  void Answer(const problems::Problem& problem);

  const SolveOptions& options_;
  const LcpSolverEntry& entry_;
  std::unique_ptr<LcpSolver> solver_;
  SolverClock clock_;
  LcpSolverResult result_;
};

}  // namespace cairn::cli
