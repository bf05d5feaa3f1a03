// SPDX-License-Identifier: MIT
// Graphs whose matrices are factorised.
#pragma once

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "cholesky/factor_pattern.h"
#include "problems.h"

namespace cairn::test {

struct FactorGraph {
  std::string name;
  int nodes = 0;
  std::vector<NodePair> pairs;  ///< ascending, each once
};

/// Any pairs of different nodes, in any order.
inline FactorGraph MakeFactorGraph(std::string name, int nodes, const std::vector<NodePair>& any) {
  std::set<NodePair> pairs;
  for (const auto& [i, j] : any) pairs.insert(std::minmax(i, j));
  return {std::move(name), nodes, {pairs.begin(), pairs.end()}};
}

inline FactorGraph ChainGraph(int nodes) {
  std::vector<NodePair> pairs;
  for (int i = 0; i + 1 < nodes; ++i) pairs.emplace_back(i, i + 1);
  return MakeFactorGraph("chain", nodes, pairs);
}

/// Everybody touches node 0.
inline FactorGraph HubGraph(int nodes) {
  std::vector<NodePair> pairs;
  for (int i = 1; i < nodes; ++i) pairs.emplace_back(0, i);
  return MakeFactorGraph("hub", nodes, pairs);
}

inline FactorGraph CliqueGraph(int nodes) {
  std::vector<NodePair> pairs;
  for (int i = 0; i < nodes; ++i) {
    for (int j = i + 1; j < nodes; ++j) pairs.emplace_back(i, j);
  }
  return MakeFactorGraph("clique", nodes, pairs);
}

/// A box of nodes, each with the next ones in three directions.
inline FactorGraph GridGraph(int x, int y, int z) {
  std::vector<NodePair> pairs;
  const auto at = [&](int i, int j, int k) { return (k * y + j) * x + i; };
  for (int k = 0; k < z; ++k) {
    for (int j = 0; j < y; ++j) {
      for (int i = 0; i < x; ++i) {
        if (i + 1 < x) pairs.emplace_back(at(i, j, k), at(i + 1, j, k));
        if (j + 1 < y) pairs.emplace_back(at(i, j, k), at(i, j + 1, k));
        if (k + 1 < z) pairs.emplace_back(at(i, j, k), at(i, j, k + 1));
      }
    }
  }
  return MakeFactorGraph("grid", x * y * z, pairs);
}

inline FactorGraph TreeGraph(int nodes, std::uint64_t seed) {
  Random random(seed);
  std::vector<NodePair> pairs;
  for (int i = 1; i < nodes; ++i) pairs.emplace_back(random.Index(i), i);
  return MakeFactorGraph("tree", nodes, pairs);
}

inline FactorGraph RandomGraph(int nodes, int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<NodePair> pairs;
  for (int k = 0; k < count; ++k) {
    const int i = random.Index(nodes), j = random.Index(nodes);
    if (i != j) pairs.emplace_back(i, j);
  }
  return MakeFactorGraph("random", nodes, pairs);
}

/// Cliques, chains and single nodes that do not touch.
inline FactorGraph IslandsGraph() {
  std::vector<NodePair> pairs;
  for (int island = 0; island < 12; ++island) {
    const int first = 10 * island;
    for (int i = first; i < first + island % 10; ++i) {
      pairs.emplace_back(i, i + 1);
      if (island % 2 == 0) pairs.emplace_back(first, i + 1);
    }
  }
  return MakeFactorGraph("islands", 120, pairs);
}

inline std::vector<FactorGraph> FactorGraphs() {
  return {{"nothing", 0, {}},      {"one node", 1, {}}, {"no pairs", 7, {}}, ChainGraph(2),
          ChainGraph(30),          HubGraph(40),        CliqueGraph(9),      CliqueGraph(20),
          GridGraph(9, 8, 1),      GridGraph(5, 4, 4),  TreeGraph(60, 1),    RandomGraph(50, 70, 2),
          RandomGraph(40, 250, 3), IslandsGraph()};
}

}  // namespace cairn::test
