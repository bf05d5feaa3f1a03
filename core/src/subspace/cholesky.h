// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <utility>

namespace cairn {

using Block6 = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Two bodies that share a row, first < second.
using BodyPair = std::pair<int, int>;

/// Cholesky factor of a sparse symmetric positive definite matrix of 6 x 6 blocks, one block row a
/// body.
class BlockCholesky {
 public:
  BlockCholesky();
  ~BlockCholesky();
  BlockCholesky(BlockCholesky&&) noexcept;
  BlockCholesky& operator=(BlockCholesky&&) noexcept;

  /// Orders the bodies and finds the pattern of the factor. @p pairs: ascending, each once.
  void Analyse(int bodies, std::span<const BodyPair> pairs);

  /// Multiply-adds of one Factorise(), from the pattern alone.
  double factor_flops() const;
  /// Entries of the factor.
  double factor_nonzeros() const;

  /// The matrix, to be filled before Factorise(): the block of a body with itself, and the block
  /// (first, second) of a pair.
  Block6& diagonal(int body);
  Block6& upper(int pair);

  /// False if the matrix is not positive definite.
  [[nodiscard]] bool Factorise();

  /// rhs := matrix^-1 rhs, one entry per body.
  void Solve(std::span<Vector6d> rhs) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace cairn
