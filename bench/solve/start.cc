// SPDX-License-Identifier: MIT
#include "solve/start.h"

#include <utility>

namespace cairn::cli {

Start FindStart(const problems::Problem& problem, StartRule rule, LcpSolver* solver,
                SolverClock clock) {
  Start start;
  start.x = Eigen::VectorXd::Zero(problem.lcp.size());
  if (rule != StartRule::kZero && problem.start.size() != 0) start.x = problem.start;
  const bool is_nested = rule == StartRule::kNested && problem.coarser && problem.prolong &&
                         problem.lcp.size() > kSmallestGrid;
  if (!is_nested) return start;

  const problems::Problem coarser = problem.coarser();
  Start below = FindStart(coarser, rule, solver, clock);
  const double begin = Now(clock);
  const LcpOutcome outcome = solver->Solve(coarser.lcp, below.x, {});
  start.x = problem.prolong(outcome.x);
  const double time = Now(clock) - begin;
  start.grids = std::move(below.grids);
  start.grids.push_back({.size = coarser.lcp.size(),
                         .time = time,
                         .sweeps = outcome.sweeps,
                         .factorisations = outcome.factorisations});
  start.time = below.time + time;
  return start;
}

}  // namespace cairn::cli
