// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <vector>

namespace cairn::lcp {

/// Cholesky factors of principal submatrices of one sparse symmetric matrix M: the reduced systems
/// of subspace minimisation, and of an interior point method the whole. The rows are ordered once.
/// The pattern of a factor is kept for the next set of rows if that fits inside and fills most of
/// it.
class SparseCholesky {
 public:
  SparseCholesky();
  ~SparseCholesky();
  SparseCholesky(SparseCholesky&&) noexcept;
  SparseCholesky& operator=(SparseCholesky&&) noexcept;

  /// Takes M, n x n, compressed, both triangles stored, columns ascending, and orders its rows. M
  /// is referred to until the next call. The order and the pattern of the last factor are kept if
  /// the M before had the same pattern.
  void Attach(const Eigen::SparseMatrix<double>& m);
  /// The same with the M and the order of another.
  void AttachLike(const SparseCholesky& other);

  /// Which rows the next factor is of: one flag per row of M. Analyses its pattern unless the last
  /// one serves.
  void Choose(const std::vector<char>& in_set);

  /// Multiply-adds of one Factorise() and entries of the factor, from the pattern alone.
  double factor_flops() const;
  double factor_nonzeros() const;
  /// Patterns analysed since the last call.
  int TakeAnalyses();

  /// Factorises the chosen rows and columns of M + diag(shift), shift: one per row of M, >= 0.
  /// False if a pivot is not positive.
  [[nodiscard]] bool Factorise(const Eigen::VectorXd& shift);

  /// rhs := (M + diag(shift))^-1 rhs on the chosen rows. rhs: one per row of M; what it holds on
  /// other rows is neither read nor written.
  void Solve(Eigen::VectorXd* rhs) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace cairn::lcp
