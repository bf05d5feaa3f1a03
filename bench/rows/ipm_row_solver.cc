// SPDX-License-Identifier: MIT
#include "rows/ipm_row_solver.h"

#include <algorithm>

#include "lcp/cairn_lcp_solver.h"
#include "measure/row_velocities.h"
#include "rigid/contact_matrix.h"

namespace cairn::cli {
namespace {

/// Relative residual at which it ends: a frame has no tolerance of that kind.
constexpr double kTolerance = 1e-12;

}  // namespace

std::string IpmRowSolver::Prepare(const RowProblem& problem) {
  const ContactProblem frame = problem.rows.problem();
  if (std::any_of(frame.rows.begin(), frame.rows.end(),
                  [](const Row& row) { return row.parent != kNoRow && row.friction > 0; })) {
    return "friction, whose bounds follow other impulses: interior points need bounds that stay";
  }
  problem_ = &problem;
  std::vector<Row> rows(frame.rows.begin(), frame.rows.end());
  for (Row& row : rows) {
    if (row.parent == kNoRow) continue;
    row.parent = kNoRow;  // friction of 0
    row.lo = row.hi = 0;
  }
  boxed_ = bench::ToBoxed({.bodies = frame.bodies, .rows = rows});
  start_ = Eigen::Map<const Eigen::VectorXd>(problem.rows.row_impulses.data(),
                                             static_cast<Eigen::Index>(rows.size()));
  return {};
}

void IpmRowSolver::IterateUntil(const RowLimit& limit) {
  LcpOptions options = options_;
  options.tolerance = kTolerance;
  options.max_sweeps.reset();
  options.budget = limit.time;
  lcp::Observer observer;
  if (limit.iterations) {
    observer = [&limit](const lcp::Iterate& iterate) {
      return iterate.factorisations < *limit.iterations;
    };
  }
  outcome_ = CairnLcpSolver(lcp::Method::kInteriorPoint, options).Solve(boxed_, start_, observer);
}

RowOutcome IpmRowSolver::Result() {
  const ContactProblem frame = problem_->rows.problem();
  RowOutcome outcome;
  outcome.impulses.assign(outcome_.x.begin(), outcome_.x.end());
  outcome.velocities = bench::FreeVelocities(frame.bodies);
  bench::Push(frame, outcome.impulses, outcome.velocities);
  outcome.iterations = outcome_.sweeps;
  outcome.factorisations = outcome_.factorisations;
  outcome.stop = outcome_.stop;
  outcome.ended = outcome_.stop != "budget spent" && outcome_.stop != "cancelled";
  outcome.failure = outcome_.failure;
  return outcome;
}

}  // namespace cairn::cli
