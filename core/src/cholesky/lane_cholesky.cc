// SPDX-License-Identifier: MIT
#include "cholesky/lane_cholesky.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace cairn {
namespace {

using simd::kLanes;
using simd::kMostNeighbours;
using simd::kNodeRows;
using simd::kNodeSquare;

/// A neighbour, and the block between it and the node.
struct Edge {
  int neighbour, block;
};

}  // namespace

/// What is left of the graph while nodes are taken out of it.
class LaneOrder {
 public:
  LaneOrder(int nodes, std::span<const NodePair> pairs)
      : blocks_(nodes), lists_(nodes), edges_(2 * pairs.size()) {
    for (const auto& [a, b] : pairs) {
      ++lists_[a].begin;
      ++lists_[b].begin;
    }
    int end = 0;
    for (List& list : lists_) list.begin = std::exchange(end, end + list.begin);
    for (const auto& [a, b] : pairs) Join(a, b);
    for (int node = 0; node < nodes; ++node) left_.push_back(node);
  }

  /// Nodes that are left.
  std::span<const int> left() const { return left_; }
  int blocks() const { return blocks_; }
  std::span<const Edge> edges(int node) const {
    return std::span(edges_).subspan(lists_[node].begin, lists_[node].size);
  }
  /// The block between two neighbours.
  int Between(int a, int b) const {
    const std::span<const Edge> of_a = edges(a);
    return std::find_if(of_a.begin(), of_a.end(), [b](const Edge& e) { return e.neighbour == b; })
        ->block;
  }

  /// Nodes with few neighbours, none beside another: those with least first. Chosen by what is near
  /// them alone, so that components do not see each other. Empty if there is none.
  std::span<const int> FindRound();
  /// Takes them out; their neighbours become neighbours of each other.
  void Remove(std::span<const int> round);

 private:
  /// Where the edges of a node are. No node gets more than it began with: one that is taken out
  /// leaves at most one edge to each of its neighbours, for its own.
  struct List {
    int begin = 0, size = 0;
  };

  void Join(int a, int b) {
    const auto append = [this](int node, int neighbour) {
      List& list = lists_[node];
      edges_[list.begin + list.size++] = {neighbour, blocks_};
    };
    append(a, b);
    append(b, a);
    ++blocks_;
  }
  /// Of @p node, the edge to that neighbour.
  void Cut(int node, int neighbour) {
    List& list = lists_[node];
    Edge* const begin = &edges_[list.begin];
    list.size = static_cast<int>(
        std::remove_if(begin, begin + list.size,
                       [neighbour](const Edge& e) { return e.neighbour == neighbour; }) -
        begin);
  }
  bool AreNeighbours(int a, int b) const {
    const std::span<const Edge> of_a = edges(a);
    return std::any_of(of_a.begin(), of_a.end(), [b](const Edge& e) { return e.neighbour == b; });
  }

  int blocks_;
  Array<List> lists_;
  Array<Edge> edges_;
  Array<int> left_, round_;
  Array<char> taken_, beside_;
};

std::span<const int> LaneOrder::FindRound() {
  round_.clear();
  taken_.assign(lists_.size(), 0);
  beside_.assign(lists_.size(), 0);
  for (int degree = 0; degree <= kMostNeighbours; ++degree) {
    for (int node : left_) {
      if (lists_[node].size != degree || beside_[node] != 0) continue;
      round_.push_back(node);
      taken_[node] = 1;
      for (const Edge& edge : edges(node)) beside_[edge.neighbour] = 1;
    }
  }
  return round_;
}

void LaneOrder::Remove(std::span<const int> round) {
  for (int node : round) {
    const std::span<const Edge> of_node = edges(node);
    for (const Edge& edge : of_node) Cut(edge.neighbour, node);
    if (of_node.size() < 2) continue;
    const int a = of_node[0].neighbour, b = of_node[1].neighbour;
    if (!AreNeighbours(a, b)) Join(a, b);
  }
  std::erase_if(left_, [this](int node) { return taken_[node] != 0; });
}

namespace {

/// By node, the first one of its component.
Array<int> FindComponents(int nodes, std::span<const NodePair> pairs) {
  Array<int> first(nodes);
  std::iota(first.begin(), first.end(), 0);
  const auto find = [&first](int node) {
    while (first[node] != node) node = first[node] = first[first[node]];
    return node;
  };
  for (const auto& [a, b] : pairs) {
    const auto [low, high] = std::minmax({find(a), find(b)});
    first[high] = low;
  }
  for (int node = 0; node < nodes; ++node) first[node] = find(node);
  return first;
}

}  // namespace

Array<char> NodesForLanes(int nodes, std::span<const NodePair> pairs, int most) {
  LaneOrder order(nodes, pairs);
  for (auto round = order.FindRound(); !round.empty(); round = order.FindRound()) {
    order.Remove(round);
  }
  const Array<int> components = FindComponents(nodes, pairs);
  Array<int> sizes(nodes, 0);
  for (int component : components) ++sizes[component];
  Array<char> left(nodes, 0), suits(nodes);
  for (int node : order.left()) left[components[node]] = 1;
  for (int node = 0; node < nodes; ++node) {
    suits[node] = left[components[node]] == 0 && sizes[components[node]] <= most ? 1 : 0;
  }
  return suits;
}

template <class T>
bool LaneCholesky<T>::Analyse(int nodes, std::span<const NodePair> pairs) {
  nodes_ = nodes;
  flops_ = nonzeros_ = 0;
  lanes_.clear();
  LaneOrder order(nodes, pairs);
  Array<int> round;
  while (!order.left().empty()) {
    const std::span<const int> found = order.FindRound();
    if (found.empty()) return false;
    // those with more neighbours first: kernels pass over what is not there
    round.assign(found.rbegin(), found.rend());
    order.Remove(found);
    AddRound(round, order);
  }
  columns_.resize(static_cast<size_t>(columns_end()));
  values_.resize(static_cast<size_t>(order.blocks()) * kNodeSquare);
  floors_.resize(static_cast<size_t>(nodes) * kNodeRows);
  SetZero();
  return true;
}

template <class T>
void LaneCholesky<T>::AddRound(std::span<const int> round, const LaneOrder& order) {
  for (size_t begin = 0; begin < round.size(); begin += kLanes) {
    const auto nodes = round.subspan(begin, std::min<size_t>(kLanes, round.size() - begin));
    const std::int32_t columns = columns_end();
    simd::NodeLanes& lanes = lanes_.emplace_back();
    lanes.lanes = static_cast<int>(nodes.size());
    lanes.columns = columns;
    for (int l = 0; l < lanes.lanes; ++l) {
      const int node = nodes[l];
      lanes.node[l] = node;
      lanes.diagonal[l] = kNodeSquare * node;
      // edges of a node stay as they were when it was taken out
      const auto edges = order.edges(node);
      const bool swap = edges.size() == 2 && edges[0].neighbour > edges[1].neighbour;
      for (size_t i = 0; i < edges.size(); ++i) {
        const Edge& edge = edges[swap ? 1 - i : i];
        auto& to = lanes.neighbours[i];
        ++lanes.with[i];
        to.block[l] = kNodeSquare * edge.block;
        to.diagonal[l] = kNodeSquare * edge.neighbour;
        to.node[l] = edge.neighbour;
        if (node < edge.neighbour) to.turned |= std::uint32_t{1} << l;
      }
      if (edges.size() == 2) {
        const auto& [first, second] = lanes.neighbours;
        lanes.between[l] = kNodeSquare * order.Between(first.node[l], second.node[l]);
      }
    }
    Count(lanes);
  }
}

template <class T>
void LaneCholesky<T>::Count(const simd::NodeLanes& lanes) {
  // a triangle, and for each neighbour the square below it and what that adds
  constexpr double kTriangle = simd::kNodeTriangle, kRows = kNodeRows;
  constexpr double kFactor = kRows * (kRows + 1) * (kRows + 2) / 6, kSquare = kRows * kRows;
  const double some = lanes.with[0] + lanes.with[1];
  flops_ += lanes.lanes * kFactor + some * (kTriangle * kRows + kTriangle * kRows) +
            lanes.with[1] * kSquare * kRows;
  nonzeros_ += lanes.lanes * kTriangle + some * kSquare;
}

template <class T>
void LaneCholesky<T>::SetZero() {
  std::fill(values_.begin(), values_.end(), T(0));
}

template <class T>
bool LaneCholesky<T>::Factorise() {
  for (int node = 0; node < nodes_; ++node) {
    const T* const block = diagonal(node);
    for (int k = 0; k < kNodeRows; ++k) {
      // not above zero: not above the floor
      const T entry = block[(kNodeRows + 1) * k];
      floors_[kNodeRows * node + k] = entry > 0 ? std::numeric_limits<T>::epsilon() * entry : 0;
    }
  }
  for (const simd::NodeLanes& lanes : lanes_) {
    if (!kernels_.eliminate(lanes, floors_.data(), values_.data(), columns_.data())) return false;
  }
  return true;
}

template <class T>
void LaneCholesky<T>::Solve(std::span<T> x) {
  for (const simd::NodeLanes& lanes : lanes_) {
    kernels_.solve_down(lanes, columns_.data(), x.data());
  }
  for (size_t i = lanes_.size(); i-- > 0;) {
    kernels_.solve_up(lanes_[i], columns_.data(), x.data());
  }
}

template class LaneCholesky<float>;
template class LaneCholesky<double>;

}  // namespace cairn
