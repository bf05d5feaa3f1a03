// SPDX-License-Identifier: MIT
#include "cholesky/elimination.h"

#include <Eigen/SparseCore>
#include <algorithm>
#include <numeric>

#include "cholesky/minimum_degree.h"

namespace cairn {
namespace {

/// The nodes that are connected, ascending; one entry for each part of the graph.
Array<Array<int>> Components(const Graph& graph) {
  const int nodes = static_cast<int>(graph.begin.size()) - 1;
  Array<char> seen(nodes, 0);
  Array<Array<int>> components;
  for (int first = 0; first < nodes; ++first) {
    if (seen[first] != 0) continue;
    Array<int>& component = components.emplace_back(1, first);
    seen[first] = 1;
    for (size_t k = 0; k < component.size(); ++k) {
      for (int neighbour : graph.of(component[k])) {
        if (std::exchange(seen[neighbour], 1) == 0) component.push_back(neighbour);
      }
    }
    std::sort(component.begin(), component.end());
  }
  return components;
}

/// Of one component; @p local: room for one entry a node.
Array<int> OrderOf(const Graph& graph, std::span<const int> component, Array<int>* local) {
  const int nodes = static_cast<int>(component.size());
  int entries = nodes;
  for (int k = 0; k < nodes; ++k) {
    (*local)[component[k]] = k;
    entries += static_cast<int>(graph.of(component[k]).size());
  }
  Array<int> order(nodes);
  // what Eigen takes for the moment is the one thing that no memory of the caller's can give
  const detail::MemoryScope of_eigen(nullptr);
  Eigen::SparseMatrix<double> matrix(nodes, nodes);
  matrix.resizeNonZeros(entries);
  int entry = 0;
  for (int j = 0; j < nodes; ++j) {
    matrix.outerIndexPtr()[j] = entry;
    const auto around = graph.of(component[j]);
    const auto above = std::lower_bound(around.begin(), around.end(), component[j]);
    for (auto i = around.begin(); i != above; ++i) matrix.innerIndexPtr()[entry++] = (*local)[*i];
    matrix.innerIndexPtr()[entry++] = j;
    for (auto i = above; i != around.end(); ++i) matrix.innerIndexPtr()[entry++] = (*local)[*i];
  }
  matrix.outerIndexPtr()[nodes] = entry;
  std::fill_n(matrix.valuePtr(), entry, 1.0);
  MinimumDegreeOrder(matrix, order);
  return order;
}

}  // namespace

Graph MakeGraph(int nodes, std::span<const NodePair> pairs) {
  Graph graph;
  graph.begin.assign(nodes + 1, 0);
  for (const auto& [i, j] : pairs) {
    ++graph.begin[i + 1];
    ++graph.begin[j + 1];
  }
  std::partial_sum(graph.begin.begin(), graph.begin.end(), graph.begin.begin());
  graph.neighbours.resize(2 * pairs.size());
  Array<int> end(graph.begin.begin(), graph.begin.end() - 1);
  // pairs ascend: first the smaller neighbours of each node, then the larger ones
  for (const auto& [i, j] : pairs) graph.neighbours[end[j]++] = i;
  for (const auto& [i, j] : pairs) graph.neighbours[end[i]++] = j;
  return graph;
}

Array<int> MinimumDegreeOrder(const Graph& graph) {
  Array<int> order, local(graph.begin.size());
  for (const Array<int>& component : Components(graph)) {
    if (component.size() <= 2) {
      order.insert(order.end(), component.begin(), component.end());
      continue;
    }
    for (int k : OrderOf(graph, component, &local)) order.push_back(component[k]);
  }
  return order;
}

Array<int> Inverse(std::span<const int> order) {
  Array<int> position(order.size());
  for (size_t k = 0; k < order.size(); ++k) position[order[k]] = static_cast<int>(k);
  return position;
}

/// A row of the factor reaches all ancestors, up to itself, of the nodes that it has entries for.
Elimination Eliminate(const Graph& graph, std::span<const int> order,
                      std::span<const int> position) {
  const int nodes = static_cast<int>(order.size());
  Array<int> parent(nodes, -1), counts(nodes, 1), reached(nodes, -1);
  for (int k = 0; k < nodes; ++k) {
    for (int neighbour : graph.of(order[k])) {
      for (int i = position[neighbour]; i < k && reached[i] != k; i = parent[i]) {
        if (parent[i] < 0) parent[i] = k;
        reached[i] = k;
        ++counts[i];
      }
    }
  }
  return {std::move(parent), std::move(counts)};
}

Children::Children(std::span<const int> parent) : first(parent.size(), -1), next(first) {
  for (int i = static_cast<int>(parent.size()) - 1; i >= 0; --i) {
    if (parent[i] >= 0) next[i] = std::exchange(first[parent[i]], i);
  }
}

void SortByMemory(const Elimination& tree, Children* children) {
  const int nodes = static_cast<int>(tree.parent.size());
  Array<double> left(nodes), most(nodes);
  Array<int> sorted;
  for (int i = 0; i < nodes; ++i) {
    left[i] = static_cast<double>(tree.counts[i] - 1) * (tree.counts[i] - 1);
    sorted.clear();
    for (int c = children->first[i]; c >= 0; c = children->next[c]) sorted.push_back(c);
    if (sorted.size() > 1) {
      // those with the same number stay in order
      std::ranges::sort(sorted, {}, [&](int c) { return std::pair(left[c] - most[c], c); });
      int* link = &children->first[i];
      for (int c : sorted) {
        *link = c;
        link = &children->next[c];
      }
      *link = -1;
    }
    double held = 0;
    for (int c : sorted) {
      most[i] = std::max(most[i], held + most[c]);
      held += left[c];
    }
    most[i] = std::max(most[i], held + left[i]);
  }
}

Array<int> Postorder(std::span<const int> parent, Children children) {
  Array<int> order, path;
  order.reserve(parent.size());
  for (int root = 0; root < static_cast<int>(parent.size()); ++root) {
    if (parent[root] < 0) path.assign(1, root);
    while (!path.empty()) {
      int& child = children.first[path.back()];
      if (child >= 0) {
        path.push_back(std::exchange(child, children.next[child]));
      } else {
        order.push_back(path.back());
        path.pop_back();
      }
    }
  }
  return order;
}

}  // namespace cairn
