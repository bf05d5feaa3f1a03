// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "cairn/detail/memory.h"
#include "cholesky/elimination.h"

namespace cairn {

/// Where the numbers of a sparse symmetric matrix and of its Cholesky factor lie: found from the
/// pattern alone. Rows come in nodes of equal size, six for a body. Nodes are eliminated in a
/// minimum degree order or in one with its fill; those that have nearly the same rows below them
/// are eliminated together, as the first columns of one dense front. What is left of a front is
/// added to its parent's.
///
/// J. W. H. Liu, "The multifrontal method for sparse matrix solution: theory and practice", SIAM
/// Review 34 (1992). Fronts are joined more sparingly than elsewhere: on graphs of bodies the zeros
/// that joining adds cost more than small fronts do.
class FactorPattern {
 public:
  /// Nodes are counted in the order of elimination here.
  struct Front {
    int first;                         ///< first pivot
    int pivots;                        ///< that many nodes
    int parent;                        ///< front, or -1
    int rows_begin, rows_end;          ///< in rows(): nodes below the pivots, ascending
    int children_begin, children_end;  ///< in children()
  };

  /// @p pairs: each once. Those that turn out to hold zeros do no harm. @p order: nodes as they are
  /// to be eliminated, up to changes that bring no fill; empty: minimum degree, for which the pairs
  /// have to ascend.
  void Analyse(int nodes, int node_size, std::span<const NodePair> pairs,
               std::span<const int> order = {});

  int nodes() const { return static_cast<int>(position_.size()); }
  int node_size() const { return node_size_; }

  /// A front comes after its children.
  std::span<const Front> fronts() const { return fronts_; }
  std::span<const int> rows(const Front& front) const {
    return std::span(rows_).subspan(front.rows_begin, front.rows_end - front.rows_begin);
  }
  /// Ascending.
  std::span<const int> children(const Front& front) const {
    return std::span(children_).subspan(front.children_begin,
                                        front.children_end - front.children_begin);
  }

  /// When each node of the caller is eliminated.
  std::span<const int> position() const { return position_; }
  /// The front that eliminates each node, which comes in the order of elimination.
  std::span<const int> front_of() const { return front_of_; }

  /// Multiplications and additions of a factorisation, and entries of the factor, without
  /// the zeros that joining fronts adds.
  double flops() const { return flops_; }
  double nonzeros() const { return nonzeros_; }
  /// Multiplications and additions of one front, zeros included.
  double flops(const Front& front) const;

 private:
  class Builder;

  int node_size_ = 1;
  Array<int> position_, front_of_;
  Array<Front> fronts_;
  Array<int> rows_, children_;
  double flops_ = 0, nonzeros_ = 0;
};

}  // namespace cairn
