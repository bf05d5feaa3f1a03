// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCore>
#include <memory>

namespace cairn::micro {

/// Eigen's simplicial Cholesky factor of a sparse symmetric matrix whose rows are in the order of
/// elimination.
class EigenCholesky {
 public:
  EigenCholesky();
  ~EigenCholesky();
  EigenCholesky(EigenCholesky&&) noexcept;
  EigenCholesky& operator=(EigenCholesky&&) noexcept;

  /// Finds the pattern of the factor. @p upper: upper triangle, compressed, rows ascending.
  void Analyse(const Eigen::SparseMatrix<double>& upper);

  /// False if a pivot is not positive. @pre the pattern is the one analysed
  [[nodiscard]] bool Factorise(const Eigen::SparseMatrix<double>& upper);
  /// rhs := matrix^-1 rhs.
  void Solve(Eigen::VectorXd* rhs) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace cairn::micro
