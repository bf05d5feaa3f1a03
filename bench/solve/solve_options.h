// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lcp/lcp_solvers.h"
#include "rows/row_problem.h"
#include "rows/row_solvers.h"
#include "solve/problem_choice.h"
#include "support/progress.h"

namespace cairn::cli {

/// Where solvers begin.
enum class StartRule {
  kZero,
  kWarm,    ///< With what the problem brings, zeros if that is nothing.
  kNested,  ///< With the solution of the next coarser grid, found in the same way.
};

/// What `cairn solve` was asked for, checked.
struct SolveOptions {
  std::vector<ProblemChoice> problems;
  std::vector<std::shared_ptr<const RowProblem>> frames;  ///< Recordings.
  std::vector<SkippedFolder> skipped;
  std::vector<UnreadFile> unread;
  std::vector<const LcpSolverEntry*> solvers;      ///< Of the problems.
  std::vector<const RowSolverEntry*> row_solvers;  ///< Of the frames.
  std::vector<std::string> solver_names;           ///< Of both, each once, as they were typed.
  LcpOptions solver;
  LcpOptions row_solver;  ///< With a budget or sweeps at most; the tolerance is in [m/s], 0: none.
  /// Errors at which the time is taken, falling; empty: errors are not measured at all.
  std::vector<double> errors;
  StartRule start = StartRule::kWarm;
  int repeat = 1;  ///< Solves that are timed; their median counts.
  ProgressMode progress = ProgressMode::kAuto;
};

/// The word a user types for it.
const char* Name(StartRule start);
const char* Name(lcp::SweepOrder order);

}  // namespace cairn::cli
