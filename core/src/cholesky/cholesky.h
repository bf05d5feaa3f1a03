// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>

#include "cholesky/factor_pattern.h"

namespace cairn {

using Block6 = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Two bodies that share a row, first < second.
using BodyPair = NodePair;

/// Cholesky factor of a sparse symmetric positive definite matrix of 6 x 6 blocks, one block row a
/// body.
class BlockCholesky {
 public:
  using Block = Eigen::Map<Block6, Eigen::Aligned16>;

  BlockCholesky();
  ~BlockCholesky();
  BlockCholesky(BlockCholesky&&) noexcept;
  BlockCholesky& operator=(BlockCholesky&&) noexcept;

  /// Orders the bodies and finds the pattern of the factor. @p pairs: ascending, each once.
  void Analyse(int bodies, std::span<const BodyPair> pairs);

  /// Multiplications and additions of one Factorise(), from the pattern alone.
  double factor_flops() const;
  /// Entries of the factor.
  double factor_nonzeros() const;

  /// The matrix, to be filled before Factorise(), which leaves it as it is: the block of a body
  /// with itself, of which the lower triangle counts, and the block (first, second) of a pair.
  Block diagonal(int body);
  Block upper(int pair);
  /// All blocks at once.
  void SetZero();

  /// False if the matrix is not positive definite.
  [[nodiscard]] bool Factorise();

  /// rhs := matrix^-1 rhs, one entry per body. Not by two threads at the same time.
  void Solve(std::span<Vector6d> rhs) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace cairn
