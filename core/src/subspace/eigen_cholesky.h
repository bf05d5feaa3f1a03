// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <vector>

namespace cairn {

/// Rows of a sparse symmetric matrix in the order in which a minimum degree method eliminates them.
/// @pre both triangles are stored, and the whole diagonal: without it Eigen takes every column for
/// a dense one, and does not order at all.
std::vector<int> MinimumDegreeOrder(const Eigen::SparseMatrix<double>& matrix);

/// Cholesky factor of a sparse symmetric matrix whose rows are in the order of elimination. The
/// only user of Eigen's sparse factorisations and orderings.
class EigenCholesky {
 public:
  EigenCholesky();
  ~EigenCholesky();
  EigenCholesky(EigenCholesky&&) noexcept;
  EigenCholesky& operator=(EigenCholesky&&) noexcept;

  /// Finds the pattern of the factor. @p upper: upper triangle, compressed, rows ascending.
  void Analyse(const Eigen::SparseMatrix<double>& upper);
  /// Multiply-adds of one Factorise() and entries of the factor, from the pattern alone.
  double flops() const;
  double nonzeros() const;

  /// False if a pivot is not positive. @pre the pattern is the one analysed
  [[nodiscard]] bool Factorise(const Eigen::SparseMatrix<double>& upper);
  /// rhs := matrix^-1 rhs.
  void Solve(Eigen::VectorXd* rhs) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace cairn
