// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "cairn/detail/memory.h"
#include "cholesky/cholesky.h"
#include "reference/active_set.h"
#include "reference/pack.h"

namespace cairn {

/// The reduced system in body space, H = I + G_F' W G_F with a weight per free row. By the Woodbury
/// identity it answers what the paper's (G_F G_F' + W^-1) asks, but it is positive definite however
/// redundant the rows are, and its pattern, the body graph, does not change with the set.
class BodySystem {
 public:
  /// Finds the body graph of the island, and analyses it unless it is the one of the last call.
  void Prepare(const PackedIsland& island);

  /// Multiply-adds of a factorisation, and entries of the factor.
  double factor_flops() const { return factor_.factor_flops(); }
  double factor_nonzeros() const { return factor_.factor_nonzeros(); }

  /// Assembles and factorises; rows of weight 0 are left out. @pre Prepare(island) was the last
  /// Prepare(). False if rounding made H indefinite.
  [[nodiscard]] bool Factorise(const PackedIsland& island, std::span<const double> weights);

  /// Solves H du = rhs in place; one entry per movable body.
  void Solve(std::span<Vector6d> rhs) const { factor_.Solve(rhs); }

 private:
  int bodies_ = -1;
  Array<BodyPair> pairs_;
  Array<int> pair_of_row_;  ///< -1 where a row touches one movable body only
  BlockCholesky factor_;
};

}  // namespace cairn
