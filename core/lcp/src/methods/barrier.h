// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "lcp_state.h"
#include "methods/row_set.h"
#include "methods/sparse_cholesky.h"

namespace cairn::lcp {

/// Mehrotra's predictor-corrector for a problem in matrix form. Every row with bounds has a slack
/// to each finite one and a multiplier z, all kept positive; w = z_lo - z_hi at the solution. Rows
/// without bounds stay equations. The system of an iteration is M with z / slack added to the
/// diagonal.
///
/// Source: S. Mehrotra, "On the implementation of a primal-dual interior point method", SIAM J.
/// Optim. 2 (1992) 575-601. Differences: one step length for x and z, which a quadratic objective
/// needs, and a start near the given x instead of a least squares solution.
class Barrier {
 public:
  /// Starts as near to @p start as its residual allows.
  Barrier(LcpState* state, SparseCholesky* factor, const Eigen::VectorXd& start);

  /// Whether an iteration fits the budget.
  bool Fits() const;
  /// One iteration. False if the matrix is indefinite.
  [[nodiscard]] bool Step();

  /// Inside the box, strictly but for rounding and for rows whose box has no inside.
  const Eigen::VectorXd& x() const { return x_; }
  /// Whether one of the last iterations made @p residual, the infeasibility or the sum of slack z
  /// clearly smaller than ever before. When none did, rounding is all that is left, or the start
  /// was far too near to the bounds: then it begins again.
  bool Advances(double residual);
  /// Length of the last step, in [0, 1].
  double step_length() const { return length_; }
  /// x with the rows whose multiplier outweighs their slack moved to the bound.
  Eigen::VectorXd Rounded() const;
  /// Which bounds the rows are heading for: where the slack shrinks faster than the multiplier in
  /// the last predictor step (the indicators of Tapia). The scale of rows does not matter to it.
  RowSet Predicted() const;

 private:
  /// One bound of one row: slack > 0 and its multiplier.
  struct Bound {
    int row;
    double sign;  ///< +1: x - lo, -1: hi - x.
    double slack, z;
    double slack_step = 0, z_step = 0;  ///< Of the last solve.
    double indicator = 0;               ///< Relative step of the slack less that of z, predictor.
  };

  /// Slacks and multipliers at least `inside_` in the scale of their rows.
  void Begin();
  bool Factorise();
  /// Solves for the step with which slack z changes by the targets, one for each bound.
  void SolveStep(const Eigen::VectorXd& targets);
  /// Largest step that keeps everything positive, at most 1 / kBoundary.
  double LongestStep() const;
  double Complementarity(double length) const;
  void Move(double length);
  void Measure();

  LcpState* state_;
  SparseCholesky* factor_;
  std::vector<Bound> bounds_;
  Eigen::VectorXd start_, x_, residual_, step_, weight_;
  std::vector<char> moves_;  ///< False for rows whose box has no inside: they are no unknowns.
  double shift_, length_ = 0, inside_ = 0;
  int restarts_ = 0;
  double infeasibility_ = 0;  ///< |M x + q - z_lo + z_hi| relative to the scale of the problem.
  /// Smallest residual, infeasibility and root of the sum of slack z so far.
  std::array<double, 3> best_ = {kInfinity, kInfinity, kInfinity};
  int idle_ = 0;
};

/// The method by itself: iterations until the problem is solved.
void RunInteriorPoint(LcpState* state, SparseCholesky* factor);

}  // namespace cairn::lcp
