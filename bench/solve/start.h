// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "lcp/lcp_solver.h"
#include "problems/problem.h"
#include "solve/solve_result.h"

namespace cairn::cli {

/// Where a solver begins, and what it took to get there.
struct Start {
  Eigen::VectorXd x;
  std::vector<NestedGrid> grids;  ///< From the coarsest on.
  double time = 0;                ///< [ms], sum over the grids
};

/// Grids of so few unknowns are not made coarser.
inline constexpr Eigen::Index kSmallestGrid = 100;

/// The start of a problem by a rule. For StartRule::kNested, `solver` solves the coarser grid,
/// which begins in the same way; making the problems is not timed.
Start FindStart(const problems::Problem& problem, StartRule rule, LcpSolver* solver,
                SolverClock clock);

}  // namespace cairn::cli
