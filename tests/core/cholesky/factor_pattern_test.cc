// SPDX-License-Identifier: MIT
// Fronts and counts against elimination in a table of yes and no.
#include "cholesky/factor_pattern.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>
#include <vector>

#include "tests/core/support/factor_graphs.h"

namespace cairn {
namespace {

using test::FactorGraph;
using Front = FactorPattern::Front;

/// Which entries the factor has, lower triangle, in the order of elimination.
std::vector<std::vector<bool>> Eliminate(const FactorGraph& graph, const FactorPattern& pattern) {
  const int nodes = graph.nodes;
  std::vector<std::vector<bool>> filled(nodes, std::vector<bool>(nodes));
  for (int i = 0; i < nodes; ++i) filled[i][i] = true;
  for (const auto& [i, j] : graph.pairs) {
    const int p = pattern.position()[i], q = pattern.position()[j];
    filled[std::max(p, q)][std::min(p, q)] = true;
  }
  for (int k = 0; k < nodes; ++k) {
    for (int j = k + 1; j < nodes; ++j) {
      for (int i = j; filled[j][k] && i < nodes; ++i) {
        if (filled[i][k]) filled[i][j] = true;
      }
    }
  }
  return filled;
}

std::set<int> RowsOf(const FactorPattern& pattern, const Front& front) {
  std::set<int> rows;
  for (int i = 0; i < front.pivots; ++i) rows.insert(front.first + i);
  for (int row : pattern.rows(front)) rows.insert(row);
  return rows;
}

TEST(FactorPattern, EliminatesEveryNodeOnce) {
  for (const FactorGraph& graph : test::FactorGraphs()) {
    SCOPED_TRACE(graph.name);
    FactorPattern pattern;
    pattern.Analyse(graph.nodes, 6, graph.pairs);
    ASSERT_EQ(pattern.nodes(), graph.nodes);
    const auto position = pattern.position();
    const std::set<int> places(position.begin(), position.end());
    EXPECT_EQ(static_cast<int>(places.size()), graph.nodes);
    int next = 0;
    for (size_t f = 0; f < pattern.fronts().size(); ++f) {
      EXPECT_EQ(pattern.fronts()[f].first, next);
      ASSERT_GE(pattern.fronts()[f].pivots, 1);
      for (int i = 0; i < pattern.fronts()[f].pivots; ++i) {
        EXPECT_EQ(pattern.front_of()[next++], static_cast<int>(f));
      }
    }
    EXPECT_EQ(next, graph.nodes);
  }
}

TEST(FactorPattern, HasAPlaceForEveryEntryOfTheFactor) {
  for (const FactorGraph& graph : test::FactorGraphs()) {
    SCOPED_TRACE(graph.name);
    FactorPattern pattern;
    pattern.Analyse(graph.nodes, 6, graph.pairs);
    const auto filled = Eliminate(graph, pattern);
    for (int j = 0; j < graph.nodes; ++j) {
      const std::set<int> rows = RowsOf(pattern, pattern.fronts()[pattern.front_of()[j]]);
      for (int i = j; i < graph.nodes; ++i) {
        if (filled[i][j]) {
          EXPECT_TRUE(rows.contains(i)) << i << ", " << j;
        }
      }
    }
  }
}

TEST(FactorPattern, HandsRowsToParentsThatHaveThem) {
  for (const FactorGraph& graph : test::FactorGraphs()) {
    SCOPED_TRACE(graph.name);
    FactorPattern pattern;
    pattern.Analyse(graph.nodes, 6, graph.pairs);
    std::vector<int> children(pattern.fronts().size());
    for (int f = 0; f < static_cast<int>(pattern.fronts().size()); ++f) {
      const Front& front = pattern.fronts()[f];
      EXPECT_TRUE(std::ranges::is_sorted(pattern.rows(front)));
      for (int child : pattern.children(front)) {
        EXPECT_EQ(pattern.fronts()[child].parent, f);
        EXPECT_LT(child, f);
      }
      children[f] = static_cast<int>(pattern.children(front).size());
    }
    for (const Front& front : pattern.fronts()) {
      if (front.parent < 0) {
        EXPECT_TRUE(pattern.rows(front).empty());
        continue;
      }
      const std::set<int> rows = RowsOf(pattern, pattern.fronts()[front.parent]);
      for (int row : pattern.rows(front)) EXPECT_TRUE(rows.contains(row)) << row;
      --children[front.parent];
    }
    for (int left : children) EXPECT_EQ(left, 0);
  }
}

TEST(FactorPattern, CountsEntriesAndMultiplyAddsWithoutJoiningFronts) {
  for (int node_size : {1, 6}) {
    for (const FactorGraph& graph : test::FactorGraphs()) {
      SCOPED_TRACE(graph.name);
      FactorPattern pattern;
      pattern.Analyse(graph.nodes, node_size, graph.pairs);
      const auto filled = Eliminate(graph, pattern);
      double nonzeros = 0, flops = 0;
      for (int j = 0; j < graph.nodes; ++j) {
        int rows = 0;
        for (int i = j; i < graph.nodes; ++i) rows += filled[i][j];
        for (int k = 0; k < node_size; ++k) {
          const double below = rows * node_size - k;
          nonzeros += below;
          flops += below * below;
        }
      }
      EXPECT_EQ(pattern.nonzeros(), nonzeros);
      EXPECT_EQ(pattern.flops(), flops);
    }
  }
}

TEST(FactorPattern, JoinsFrontsWhereThatAddsFewZeros) {
  for (const FactorGraph& graph : test::FactorGraphs()) {
    SCOPED_TRACE(graph.name);
    FactorPattern pattern;
    pattern.Analyse(graph.nodes, 6, graph.pairs);
    double flops = 0;
    for (const Front& front : pattern.fronts()) flops += pattern.flops(front);
    EXPECT_GE(flops, pattern.flops());
    // at most 18 % of the entries of a front are zeros
    EXPECT_LE(flops, 1.6 * pattern.flops());
  }
}

// A clique of n numbers is a dense triangle, column by column: n (n + 1) (2 n + 1) / 6.
TEST(FactorPattern, MakesOneFrontOfAClique) {
  for (int node_size : {1, 6}) {
    const FactorGraph graph = test::CliqueGraph(10);
    FactorPattern pattern;
    pattern.Analyse(graph.nodes, node_size, graph.pairs);
    ASSERT_EQ(pattern.fronts().size(), 1u);
    const double n = 10.0 * node_size, dense = n * (n + 1) * (2 * n + 1) / 6;
    EXPECT_EQ(pattern.flops(), dense);
    EXPECT_EQ(pattern.flops(pattern.fronts()[0]), dense);
  }
}

// An order that leaves the hub to the end has no fill: a column of two nodes for every other one.
TEST(FactorPattern, LeavesAHubToTheEnd) {
  const FactorGraph graph = test::HubGraph(40);
  FactorPattern pattern;
  pattern.Analyse(graph.nodes, 1, graph.pairs);
  EXPECT_EQ(pattern.nonzeros(), 39 * 2 + 1);
  EXPECT_GE(pattern.position()[0], 38);
}

}  // namespace
}  // namespace cairn
