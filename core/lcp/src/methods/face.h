// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "lcp_state.h"
#include "methods/row_set.h"
#include "methods/sparse_cholesky.h"

namespace cairn::lcp {

/// Reduced systems of a problem in matrix form: rows at a side stand at that bound, the free ones
/// solve their equations.
class FaceSolver {
 public:
  /// Smallest proximal term, relative to the diagonal. Refinement takes it out again where the
  /// matrix is not singular.
  static constexpr double kLeastShift = 1e-11;
  /// No semidefinite matrix needs more: rounding does not reach so far.
  static constexpr double kMostShift = 1e-7;

  /// @p factor: attached to the matrix of the problem.
  FaceSolver(LcpState* state, SparseCholesky* factor) : state_(state), factor_(factor) {}

  /// Whether the factorisation of this set fits the budget.
  bool Fits(const RowSet& set);
  /// What it costs, in sweeps.
  double CostInSweeps(const RowSet& set);

  /// Solves with the matrix itself. False if it is not positive definite.
  [[nodiscard]] bool SolveExactly(const RowSet& set, Eigen::VectorXd* y);

  /// Solves with a proximal term about the given y, raised until the matrix can be factorised, and
  /// refines until rounding is left: the solution is that of the matrix itself where that has one.
  /// False if no term up to kMostShift helps: the matrix is indefinite.
  [[nodiscard]] bool Solve(const RowSet& set, Eigen::VectorXd* y);

 private:
  void Choose(const RowSet& set);
  bool Factorise(const RowSet& set, double shift);
  /// y_F -= (M_FF + shift)^-1 w_F. Returns the size of w_F before.
  double Correct(const RowSet& set, Eigen::VectorXd* y);

  LcpState* state_;
  SparseCholesky* factor_;
  double shift_ = kLeastShift;
};

}  // namespace cairn::lcp
