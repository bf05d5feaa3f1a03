// SPDX-License-Identifier: MIT
#include "rows/mlcp_row_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "contestants/bullet_contestants.h"
#include "measure/row_velocities.h"
#include "rigid/contact_matrix.h"

namespace cairn::cli {
namespace {

/// btContactSolverInfo::m_globalCfm of 1e-5, as for the Dantzig solver of `cairn run`, in steps of
/// 1/60 s: without it the matrix of any resting box is singular.
constexpr double kDantzigDiagonal = 1e-5 * 60;

btScalar Bounded(double bound) {
  constexpr double kMost = SIMD_INFINITY;
  return static_cast<btScalar>(std::clamp(bound, -kMost, kMost));
}

/// The same rows without parents, which a matrix does not know.
std::vector<Row> WithoutParents(std::span<const Row> rows) {
  std::vector<Row> copy(rows.begin(), rows.end());
  for (Row& row : copy) row.parent = kNoRow;
  return copy;
}

}  // namespace

std::string MlcpRowSolver::Prepare(const RowProblem& problem) {
  const ContactProblem frame = problem.rows.problem();
  const int n = static_cast<int>(frame.rows.size());
  if (n > SafeMlcpSolver::kMostRows) {
    return fmt::format("{} rows: dense matrices of more than {} take too long", n,
                       SafeMlcpSolver::kMostRows);
  }
  problem_ = &problem;
  const std::vector<Row> rows = WithoutParents(frame.rows);
  const BoxedLcp boxed = bench::ToBoxed({.bodies = frame.bodies, .rows = rows});
  a_.resize(n, n);
  a_.setZero();
  for (int column = 0; column < n; ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator it(boxed.M, column); it; ++it) {
      const double extra = it.row() == column ? diagonal_ : 0;
      a_.setElem(static_cast<int>(it.row()), column, static_cast<btScalar>(it.value() + extra));
    }
  }
  for (btVectorXu* vector : {&b_, &x_, &lo_, &hi_}) vector->resize(n);
  limits_.resize(n);
  for (int i = 0; i < n; ++i) {
    const Row& row = frame.rows[i];
    const bool follows = row.parent != kNoRow;
    if (follows && std::isfinite(row.hi) && row.hi != row.friction) {
      return fmt::format("row {} has bounds of its own besides those of its contact", i);
    }
    limits_[i] = row.parent;
    b_[i] = static_cast<btScalar>(-boxed.q[i]);
    x_[i] = static_cast<btScalar>(problem.rows.row_impulses[i]);
    lo_[i] = Bounded(follows ? -row.friction : row.lo);
    hi_[i] = Bounded(follows ? row.friction : row.hi);
  }
  iterations_ = 0;
  gave_up_ = false;
  return {};
}

bool MlcpRowSolver::Solve(btMLCPSolverInterface* solver, int iterations) {
  iterations_ += iterations;
  return solver->solveMLCP(a_, b_, x_, lo_, hi_, limits_, iterations);
}

RowOutcome MlcpRowSolver::Result() {
  const ContactProblem frame = problem_->rows.problem();
  RowOutcome outcome;
  for (int i = 0; i < x_.rows(); ++i) outcome.impulses.push_back(x_[i]);
  outcome.velocities = bench::FreeVelocities(frame.bodies);
  bench::Push(frame, outcome.impulses, outcome.velocities);
  outcome.iterations = iterations_;
  outcome.stop = "effort spent";
  return outcome;
}

void PgsMlcpRowSolver::IterateUntil(const RowLimit& limit) {
  const RowStop stop(limit);
  for (int next = 1; !stop(iterations_);) {
    if (limit.iterations) next = std::min(next, *limit.iterations - iterations_);
    Solve(&solver_, next);
    if (!limit.time) {
      next *= 2;
      continue;
    }
    const auto each = stop.spent() / iterations_;
    const auto fit = (*limit.time - stop.spent()) / std::max(each, std::chrono::nanoseconds(1));
    next = static_cast<int>(std::clamp<std::int64_t>(fit, 1, 2 * std::int64_t{next}));
  }
}

DantzigRowSolver::DantzigRowSolver() : MlcpRowSolver(kDantzigDiagonal) {}

void DantzigRowSolver::IterateUntil(const RowLimit&) { gave_up_ = !Solve(&solver_, 0); }

RowOutcome DantzigRowSolver::Result() {
  RowOutcome outcome = MlcpRowSolver::Result();
  outcome.ended = true;
  outcome.stop = gave_up_ ? "gave up" : "done";
  if (gave_up_) outcome.failure = "Bullet's Dantzig solver found no solution and kept the start";
  return outcome;
}

}  // namespace cairn::cli
