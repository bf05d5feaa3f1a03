// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "cairn/lcp/problem.h"
#include "cairn/lcp/settings.h"
#include "cairn/lcp/solver.h"
#include "methods/sparse_cholesky.h"
#include "runtime/budget.h"
#include "runtime/crew.h"

namespace cairn::lcp {

/// Solves problems in matrix form by every Method. Keeps the elimination order while the pattern of
/// the matrix stays the same from one problem to the next.
class LcpSolver {
 public:
  /// See Solver::Solve(). @pre the settings are valid
  Report Solve(const BoxedLcp& problem, const Settings& settings, const Observer& observer,
               Eigen::VectorXd* x);

 private:
  SparseCholesky reduced_, whole_;
  WorkPrices prices_;
  Crew crew_{1};
};

}  // namespace cairn::lcp
