// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "cairn/mixed_lcp.h"
#include "lcp/siconos_call.h"

namespace cairn::cli {

/// A problem in the form in which Siconos is fastest.
///
/// Lower bounds are moved to 0. Free rows u, those of A in [A C; C' B], are eliminated:
///   (B - C' A^-1 C) v + b - C' A^-1 a,   u = -A^-1 (C v + a),
/// with the sparse Cholesky factors of Siconos. Its own solvers for mixed problems have dense
/// matrices of all rows: on a wall with 1680 free and 840 other rows (condition 1e6), its
/// MLCP_LCP_LEMKE, which eliminates with dense LU factors, took 2.8 s where this and LEMKE took
/// 0.36 s, and 100 sweeps of its MLCP_PGS took 5 s. What is left is scaled with d = diag(M),
///   z = D^1/2 v,   D^-1/2 M D^-1/2,   D^-1/2 q,
/// so that the natural map of Siconos becomes LcpResidual::relative and its absolute thresholds
/// have a meaning. The sweeps of Gauss-Seidel are the same with and without.
class SiconosForm {
 public:
  /// Looks at the bounds. @return why Siconos cannot solve this; empty if it can
  std::string Choose(const BoxedLcp& problem);
  /// Complementary rows. @pre Choose() returned ""
  Eigen::Index rows() const { return static_cast<Eigen::Index>(bounded_.size()); }

  /// What the elimination needs [byte]; 0 without free rows. @pre as for rows()
  double Memory() const;

  /// @param start  inside the bounds
  /// @return why it cannot be done; empty if it was
  /// @pre Choose() returned "" for the same problem
  std::string Build(const BoxedLcp& problem, const Eigen::VectorXd& start);
  const PlainLcp& lcp() const { return lcp_; }
  /// The tolerance of lcp() that is `relative`, an LcpResidual::relative, for the problem itself.
  double Tolerance(double relative) const { return relative * tolerance_ratio_; }

  /// The x that a z >= 0 of lcp() stands for.
  Eigen::VectorXd Restore(const Eigen::VectorXd& z) const;

 private:
  /// Rows `rows` and columns `columns` of M.
  enum class Part { kFree, kBounded };
  Eigen::SparseMatrix<double> Block(const BoxedLcp& problem, Part rows, Part columns) const;
  bool Eliminate(const BoxedLcp& problem);

  std::vector<int> free_, bounded_;  ///< Rows of the problem.
  std::vector<int> place_;           ///< Of each row of the problem, in its list.
  std::vector<Part> part_;
  PlainLcp lcp_;
  Eigen::VectorXd shift_;  ///< Lower bounds, 0 for free rows.
  Eigen::VectorXd scale_;  ///< sqrt(d) of the bounded rows.
  Eigen::SparseMatrix<double> C_;
  Eigen::MatrixXd inverse_;  ///< A^-1 (C, a)
  double tolerance_ratio_ = 1;
};

}  // namespace cairn::cli
