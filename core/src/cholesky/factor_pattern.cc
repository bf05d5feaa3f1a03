// SPDX-License-Identifier: MIT
#include "cholesky/factor_pattern.h"

#include <algorithm>
#include <utility>

#include "cholesky/elimination.h"

namespace cairn {
namespace {

/// n^2 + (n - 1)^2 + ... + 1.
double SumOfSquares(double n) { return n * (n + 1) * (2 * n + 1) / 6; }

/// Time of a front of scalars, in multiplications and additions of a large one: what comes with
/// every front, with an entry of its padded columns, and with one of what it leaves to its parent.
double ScalarCost(int pivots, int rows) {
  constexpr double kFront = 500, kEntry = 8, kUpdateEntry = 12;
  const auto padded = [](int count) { return (count + 3) / 4 * 4; };
  const double longest = rows, below = rows - pivots;
  const double entries = pivots * static_cast<double>(padded(pivots) + padded(rows - pivots));
  return kFront + kEntry * entries + kUpdateEntry * below * (below + 1) / 2 +
         SumOfSquares(longest) - SumOfSquares(below);
}

/// Nodes that are eliminated together, as they are joined.
struct Group {
  int pivots = 0, rows = 0;  ///< rows with those of the pivots
  double zeros = 0;          ///< entries of its columns that joining has added
  double cost = 0;

  Group() = default;
  Group(int pivot_count, int row_count, double zero_count)
      : pivots(pivot_count),
        rows(row_count),
        zeros(zero_count),
        cost(ScalarCost(pivot_count, row_count)) {}
  double entries() const { return pivots * (rows - 0.5 * (pivots - 1)); }
};

/// A child of the group, eliminated with it.
Group Joined(const Group& child, const Group& group) {
  Group both{child.pivots + group.pivots, child.pivots + group.rows, 0};
  both.zeros = child.zeros + group.zeros + both.entries() - child.entries() - group.entries();
  return both;
}

/// Whether a group and its child are better off as one. Blocks: small fronts run slower, so zeros
/// are worth more there.
bool WorthJoining(const Group& child, const Group& group, const Group& both, int node_size) {
  if (node_size == 1) return both.cost <= child.cost + group.cost;
  const int columns = both.pivots * node_size;
  const double most = columns <= 24 ? 0.18 : columns <= 48 ? 0.10 : columns <= 96 ? 0.06 : 0.015;
  return both.zeros <= most * both.entries();
}

/// The group of each node, by the last of its nodes.
Array<int> JoinNodes(std::span<const int> parent, std::span<const int> counts, int node_size) {
  const int nodes = static_cast<int>(parent.size());
  Array<Group> groups(nodes);
  Array<int> joined_to(nodes);
  const Children children(parent);
  Array<std::pair<double, int>> candidates;
  for (int i = 0; i < nodes; ++i) {
    groups[i] = {1, counts[i], 0};
    joined_to[i] = i;
    const auto join = [&](int child) {
      const Group both = Joined(groups[child], groups[i]);
      if (!WorthJoining(groups[child], groups[i], both, node_size)) return;
      groups[i] = both;
      joined_to[child] = i;
    };
    const int first = children.first[i];
    if (first >= 0 && children.next[first] < 0) {
      join(first);
      continue;
    }
    candidates.clear();
    for (int child = first; child >= 0; child = children.next[child]) {
      candidates.emplace_back(Joined(groups[child], groups[i]).zeros, child);
    }
    std::sort(candidates.begin(), candidates.end());
    for (const auto& [zeros, child] : candidates) join(child);
  }
  for (int i = nodes - 1; i >= 0; --i) joined_to[i] = joined_to[joined_to[i]];
  return joined_to;
}

}  // namespace

/// What the steps of one analysis leave for the next.
class FactorPattern::Builder {
 public:
  Builder(FactorPattern* pattern, int nodes, std::span<const NodePair> pairs)
      : pattern_(*pattern), graph_(MakeGraph(nodes, pairs)) {}

  void Build(std::span<const int> order) {
    OrderNodes(order.empty() ? MinimumDegreeOrder(graph_) : Array<int>(order.begin(), order.end()));
    CountEntries();
    MakeFronts();
    FindRows();
    FindChildren();
  }

 private:
  /// Postorder: the same fill, and groups are close together.
  void OrderNodes(std::span<const int> chosen) {
    const Elimination elimination = Eliminate(graph_, chosen, Inverse(chosen));
    Children children(elimination.parent);
    if (pattern_.node_size_ == 1) SortByMemory(elimination, &children);
    const Array<int> order = Postorder(elimination.parent, std::move(children));
    Reorder(chosen, elimination.parent, order);
    counts_.resize(order.size());
    for (size_t k = 0; k < order.size(); ++k) counts_[k] = elimination.counts[order[k]];
  }

  void Reorder(std::span<const int> before, std::span<const int> parent,
               std::span<const int> order) {
    const Array<int> place = Inverse(order);
    order_.resize(order.size());
    parent_.resize(order.size());
    for (size_t k = 0; k < order.size(); ++k) {
      order_[k] = before[order[k]];
      parent_[k] = parent[order[k]] >= 0 ? place[parent[order[k]]] : -1;
    }
    pattern_.position_ = Inverse(order_);
  }

  void CountEntries() {
    pattern_.flops_ = pattern_.nonzeros_ = 0;
    for (int count : counts_) {
      for (int k = 0; k < pattern_.node_size_; ++k) {
        const double below = static_cast<double>(count) * pattern_.node_size_ - k;
        pattern_.nonzeros_ += below;
        pattern_.flops_ += below * below;
      }
    }
  }

  /// Groups in the order of their last nodes, which is a postorder of theirs, and the nodes of a
  /// group as they were.
  void MakeFronts() {
    const int nodes = static_cast<int>(order_.size());
    const Array<int> group = JoinNodes(parent_, counts_, pattern_.node_size_);
    Array<int> front_of_group(nodes, -1);
    pattern_.fronts_.clear();
    for (int i = 0; i < nodes; ++i) {
      if (group[i] != i) continue;
      front_of_group[i] = static_cast<int>(pattern_.fronts_.size());
      pattern_.fronts_.push_back({});
    }
    for (int i = 0; i < nodes; ++i) ++pattern_.fronts_[front_of_group[group[i]]].pivots;
    int first = 0;
    for (Front& front : pattern_.fronts_) {
      front.first = first;
      first += front.pivots;
    }
    Array<int> next, order(nodes);
    for (const Front& front : pattern_.fronts_) next.push_back(front.first);
    pattern_.front_of_.resize(nodes);
    for (int i = 0; i < nodes; ++i) {
      const int front = front_of_group[group[i]];
      order[next[front]] = i;
      pattern_.front_of_[next[front]++] = front;
    }
    Reorder(Array<int>(order_), Array<int>(parent_), order);
  }

  /// What pivots and children have below the pivots.
  void FindRows() {
    Array<int> seen(order_.size(), -1);
    Array<int>& rows = pattern_.rows_;
    rows.clear();
    const int fronts = static_cast<int>(pattern_.fronts_.size());
    Array<int> first_child(fronts, -1), next_sibling(fronts, -1);
    for (int f = 0; f < fronts; ++f) {
      Front& front = pattern_.fronts_[f];
      const int begin = static_cast<int>(rows.size()), end = front.first + front.pivots;
      const auto add = [&](int row) {
        if (row < end || std::exchange(seen[row], f) == f) return;
        rows.push_back(row);
      };
      for (int i = front.first; i < end; ++i) {
        for (int neighbour : graph_.of(order_[i])) add(pattern_.position_[neighbour]);
      }
      for (int child = first_child[f]; child >= 0; child = next_sibling[child]) {
        const Front& below = pattern_.fronts_[child];
        for (int k = below.rows_begin; k < below.rows_end; ++k) add(rows[k]);
      }
      std::sort(rows.begin() + begin, rows.end());
      front.rows_begin = begin;
      front.rows_end = static_cast<int>(rows.size());
      front.parent = begin < front.rows_end ? pattern_.front_of_[rows[begin]] : -1;
      if (front.parent < 0) continue;
      next_sibling[f] = first_child[front.parent];
      first_child[front.parent] = f;
    }
  }

  void FindChildren() {
    Array<Front>& fronts = pattern_.fronts_;
    for (Front& front : fronts) front.children_begin = front.children_end = 0;
    for (const Front& front : fronts) {
      if (front.parent >= 0) ++fronts[front.parent].children_end;
    }
    int begin = 0;
    for (Front& front : fronts) {
      const int count = front.children_end;
      front.children_begin = front.children_end = begin;
      begin += count;
    }
    pattern_.children_.resize(begin);
    for (int f = 0; f < static_cast<int>(fronts.size()); ++f) {
      if (fronts[f].parent < 0) continue;
      pattern_.children_[fronts[fronts[f].parent].children_end++] = f;
    }
  }

  FactorPattern& pattern_;
  Graph graph_;
  Array<int> order_, parent_, counts_;  ///< by position
};

void FactorPattern::Analyse(int nodes, int node_size, std::span<const NodePair> pairs,
                            std::span<const int> order) {
  node_size_ = node_size;
  Builder(this, nodes, pairs).Build(order);
}

double FactorPattern::flops(const Front& front) const {
  const double pivots = static_cast<double>(front.pivots) * node_size_;
  const double longest = pivots + static_cast<double>(rows(front).size()) * node_size_;
  return SumOfSquares(longest) - SumOfSquares(longest - pivots);
}

}  // namespace cairn
