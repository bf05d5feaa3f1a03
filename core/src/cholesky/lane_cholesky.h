// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cairn/detail/memory.h"
#include "cholesky/elimination.h"
#include "cholesky/line_allocator.h"
#include "simd/fronts/node_kernels.h"
#include "simd/target.h"

namespace cairn {

class LaneOrder;

/// Which nodes are of components that LaneCholesky can take, and of at most @p most nodes: by node,
/// 0 or 1.
Array<char> NodesForLanes(int nodes, std::span<const NodePair> pairs, int most);

/// Block Cholesky factor of a sparse symmetric positive definite matrix whose graph is made of
/// trees, chains, rings and what else can be taken apart node by node so that none has more than
/// two neighbours left: stacks, dolls, bridges, slabs on columns. All nodes that are not neighbours
/// of each other are eliminated together, sixteen at a time, one in each lane: a chain of 30 bodies
/// takes five rounds. Without fronts, lists of children, or memory but in Analyse(). Same bits on
/// every target, and the same for a component whatever is beside it.
///
/// G. L. Miller, J. H. Reif, "Parallel tree contraction and its application", FOCS 1985: leaves are
/// raked, chains compressed. Ours does so with nodes of the factor, and with rings.
template <class T>
class LaneCholesky {
 public:
  explicit LaneCholesky(simd::Target target) : kernels_(simd::NodeKernelsFor<T>(target)) {}

  /// Finds the order of elimination. False if there is none, see NodesForLanes(); then it is of no
  /// use. The matrix is zero after it. @p pairs: of nodes that are neighbours, each once,
  /// ascending; those that turn out to hold zeros do no harm.
  bool Analyse(int nodes, std::span<const NodePair> pairs);

  /// Multiplications and additions of a factorisation, and entries of the factor.
  double flops() const { return flops_; }
  double nonzeros() const { return nonzeros_; }

  /// The matrix, which Factorise() spoils: see FrontCholesky::diagonal() with nodes of six rows.
  T* diagonal(int node) { return values_.data() + simd::kNodeSquare * node; }
  T* upper(int pair) { return values_.data() + simd::kNodeSquare * (nodes_ + pair); }
  void SetZero();

  /// False if the matrix is not positive definite: if rounding leaves of a pivot no more than that
  /// of its diagonal entry, or if it is not finite.
  [[nodiscard]] bool Factorise();

  /// x := matrix^-1 x, six numbers a node. @pre Factorise() succeeded
  void Solve(std::span<T> x);

 private:
  void AddRound(std::span<const int> round, const LaneOrder& order);
  void Count(const simd::NodeLanes& lanes);
  std::int32_t columns_end() const { return lanes_.empty() ? 0 : lanes_.back().columns_end(); }

  const simd::NodeKernels<T>& kernels_;
  int nodes_ = 0;
  double flops_ = 0, nonzeros_ = 0;
  Array<simd::NodeLanes> lanes_;  ///< in the order of elimination
  std::vector<T, LineAllocator<T>> columns_, values_, floors_;
};

extern template class LaneCholesky<float>;
extern template class LaneCholesky<double>;

}  // namespace cairn
