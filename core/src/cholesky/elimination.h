// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <utility>

#include "cairn/detail/memory.h"

namespace cairn {

/// Two nodes with a block of numbers between them, first < second.
using NodePair = std::pair<int, int>;

/// Neighbours of every node: what a sparse matrix without numbers is.
struct Graph {
  Array<int> begin, neighbours;

  std::span<const int> of(int node) const {
    return std::span(neighbours).subspan(begin[node], begin[node + 1] - begin[node]);
  }
};

/// Both directions of every pair. Neighbours ascend if the pairs do.
Graph MakeGraph(int nodes, std::span<const NodePair> pairs);

/// Minimum degree, of each component as if it were alone: what is connected to nothing else gets
/// the same bits whatever is beside it. Neighbours ascend.
Array<int> MinimumDegreeOrder(const Graph& graph);

/// Where each entry of a permutation is.
Array<int> Inverse(std::span<const int> order);

/// By the order of elimination: the first node that each one brings fill to, or -1, and the entries
/// of its column of the factor, with the diagonal.
struct Elimination {
  Array<int> parent, counts;
};

Elimination Eliminate(const Graph& graph, std::span<const int> order,
                      std::span<const int> position);

/// The children of each node as a list that may be put into another order.
struct Children {
  explicit Children(std::span<const int> parent);

  Array<int> first, next;
};

/// Of the children of one node those come first that need the most memory beyond what they leave
/// to it: then the whole tree needs the least.
///
/// J. W. H. Liu, "On the storage requirement in the out-of-core multifrontal method", ACM TOMS 12
/// (1986).
void SortByMemory(const Elimination& tree, Children* children);

/// Children before their parent, those of one parent next to each other with all that is below
/// them.
Array<int> Postorder(std::span<const int> parent, Children children);

}  // namespace cairn
