// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

#include "rows/row_error_meter.h"
#include "rows/row_solvers.h"
#include "solve/solve_options.h"
#include "solve/solve_result.h"

namespace cairn::cli {

/// One solver on one recorded frame: again and again from the same start with growing effort, so
/// that neither looking on nor stopping ever counts.
class RowRun {
 public:
  /// @param show  is called with what is being done
  RowRun(const SolveOptions& options, const RowSolverEntry& entry, SolverClock clock,
         std::function<void(const std::string&)> show);

  LcpSolverResult Solve(const RowProblem& problem, const RowErrorMeter& meter);

 private:
  /// The median time of the repetitions [ms], and the outcome of the last.
  /// @return false if the solver refused or broke down; then result_ says why.
  bool Try(const RowProblem& problem, const RowLimit& limit, RowOutcome* outcome, double* time);
  void Keep(const RowOutcome& outcome, const RowError& error, double time);
  void Finish(const RowProblem& problem, const RowOutcome& last, const RowError& error);

  const SolveOptions& options_;
  const RowSolverEntry& entry_;
  std::unique_ptr<RowSolver> solver_;
  SolverClock clock_;
  std::function<void(const std::string&)> show_;
  LcpSolverResult result_;
};

/// Efforts that a solver is tried with, rising: iterations if --max-sweeps says how many, else
/// times up to the budget.
std::vector<RowLimit> Efforts(const SolveOptions& options);

/// Everything about a frame but its solvers.
ProblemResult DescribeFrame(const RowProblem& problem, const RowErrorMeter& meter);

}  // namespace cairn::cli
