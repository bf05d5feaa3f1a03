// SPDX-License-Identifier: MIT
// The factor in lanes against the dense one of Eigen, and against itself on other targets and
// beside other graphs.
#include "cholesky/lane_cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <limits>
#include <vector>

#include "tests/core/support/factor_matrices.h"

namespace cairn {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::FactorGraph;
using test::Fill;
using test::RandomMatrix;
using test::RandomVector;
using test::SameBits;

FactorGraph RingGraph(int nodes) {
  FactorGraph graph = test::ChainGraph(nodes);
  graph.pairs.emplace_back(0, nodes - 1);
  return test::MakeFactorGraph("ring", nodes, graph.pairs);
}

/// Two chains with rungs between them: every node in between has three neighbours.
FactorGraph LadderGraph(int rungs) {
  std::vector<NodePair> pairs;
  for (int i = 0; i < rungs; ++i) {
    pairs.emplace_back(2 * i, 2 * i + 1);
    if (i + 1 == rungs) break;
    pairs.emplace_back(2 * i, 2 * i + 2);
    pairs.emplace_back(2 * i + 1, 2 * i + 3);
  }
  return test::MakeFactorGraph("ladder", 2 * rungs, pairs);
}

/// Graphs that lanes take, with more nodes than lanes, and fewer.
std::vector<FactorGraph> LaneGraphs() {
  return {{"nothing", 0, {}},  {"one node", 1, {}},    {"no pairs", 40, {}},
          test::ChainGraph(2), test::ChainGraph(30),   test::ChainGraph(200),
          test::HubGraph(40),  test::TreeGraph(60, 1), test::TreeGraph(300, 2),
          RingGraph(3),        RingGraph(37),          LadderGraph(20),
          test::CliqueGraph(3)};
}

template <class T>
class LaneCholeskyIn : public testing::Test {};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(LaneCholeskyIn, Numbers);

template <class T>
void ExpectSolves(const FactorGraph& graph, LaneCholesky<T>* factor, std::uint64_t seed) {
  const MatrixXd matrix = RandomMatrix(graph, 6, 1.1, seed);
  Fill(graph, 6, matrix, factor);
  ASSERT_TRUE(factor->Factorise());
  const std::vector<double> rhs = RandomVector(6 * graph.nodes);
  std::vector<T> x(rhs.begin(), rhs.end());
  factor->Solve(x);
  if (rhs.empty()) return;
  const VectorXd expected =
      matrix.llt().solve(Eigen::Map<const VectorXd>(rhs.data(), static_cast<int>(rhs.size())));
  for (size_t i = 0; i < x.size(); ++i) {
    ASSERT_NEAR(x[i], expected[i],
                100 * std::numeric_limits<T>::epsilon() * expected.cwiseAbs().maxCoeff())
        << i;
  }
}

TYPED_TEST(LaneCholeskyIn, SolvesWhatTheDenseFactorSolves) {
  LaneCholesky<TypeParam> factor(simd::BestTarget());  // one for all
  for (const FactorGraph& graph : LaneGraphs()) {
    SCOPED_TRACE(testing::Message() << graph.name << " of " << graph.nodes);
    ASSERT_TRUE(factor.Analyse(graph.nodes, graph.pairs));
    for (std::uint64_t seed : {1, 2}) ExpectSolves(graph, &factor, seed);
  }
}

TYPED_TEST(LaneCholeskyIn, RefusesGraphsWithManyNeighbours) {
  LaneCholesky<TypeParam> factor(simd::BestTarget());
  EXPECT_FALSE(factor.Analyse(4, test::CliqueGraph(4).pairs));
  EXPECT_FALSE(factor.Analyse(64, test::GridGraph(8, 8, 1).pairs));
  const FactorGraph chain = test::ChainGraph(5);
  ASSERT_TRUE(factor.Analyse(chain.nodes, chain.pairs));
  ExpectSolves(chain, &factor, 3);
}

// A grid and two chains: the grid is not for lanes, nor a chain that is too long.
TEST(NodesForLanes, AreThoseOfComponentsThatSuit) {
  const FactorGraph grid = test::GridGraph(4, 4, 1);
  std::vector<NodePair> pairs = grid.pairs;
  for (int i = 0; i < 4; ++i) pairs.emplace_back(16 + i, 17 + i);
  for (int i = 0; i < 9; ++i) pairs.emplace_back(21 + i, 22 + i);
  const auto suits = NodesForLanes(32, test::MakeFactorGraph("three", 32, pairs).pairs, 5);
  for (int node = 0; node < 32; ++node) {
    const bool of_short_chain = node >= 16 && node < 21, alone = node == 31;
    EXPECT_EQ(suits[node] != 0, of_short_chain || alone) << node;
  }
}

TYPED_TEST(LaneCholeskyIn, CountsWhatItDoes) {
  LaneCholesky<TypeParam> factor(simd::BestTarget());
  // two nodes: two triangles of 56 operations, a square of 126 and its product with itself of 126
  ASSERT_TRUE(factor.Analyse(2, test::ChainGraph(2).pairs));
  EXPECT_EQ(factor.flops(), 2 * 56 + 2 * 126);
  EXPECT_EQ(factor.nonzeros(), 2 * 21 + 36);
  // three in a ring: the first has two neighbours, whose product is of 216
  ASSERT_TRUE(factor.Analyse(3, RingGraph(3).pairs));
  EXPECT_EQ(factor.flops(), 3 * 56 + 3 * 2 * 126 + 216);
  EXPECT_EQ(factor.nonzeros(), 3 * 21 + 3 * 36);
}

TYPED_TEST(LaneCholeskyIn, SaysWhenTheMatrixIsNotPositiveDefinite) {
  for (const FactorGraph& graph : {test::ChainGraph(8), test::HubGraph(20), RingGraph(9)}) {
    SCOPED_TRACE(graph.name);
    LaneCholesky<TypeParam> factor(simd::BestTarget());
    ASSERT_TRUE(factor.Analyse(graph.nodes, graph.pairs));
    const MatrixXd indefinite = RandomMatrix(graph, 6, 0.05, 7);
    ASSERT_EQ(indefinite.llt().info(), Eigen::NumericalIssue);
    Fill(graph, 6, indefinite, &factor);
    EXPECT_FALSE(factor.Factorise());
    ExpectSolves(graph, &factor, 8);  // and recovers
    const MatrixXd matrix = RandomMatrix(graph, 6, 1.1, 8);
    for (int node = 0; node < graph.nodes; ++node) {
      for (TypeParam bad : {std::numeric_limits<TypeParam>::quiet_NaN(),
                            std::numeric_limits<TypeParam>::infinity(), TypeParam(-1)}) {
        Fill(graph, 6, matrix, &factor);
        factor.diagonal(node)[35] = bad;
        EXPECT_FALSE(factor.Factorise()) << node << ": " << bad;
      }
    }
    factor.SetZero();
    EXPECT_FALSE(factor.Factorise());
  }
}

// Two equal rows of a node: what is left of the second pivot is rounding, with either sign.
TYPED_TEST(LaneCholeskyIn, TakesRoundingOfASingularMatrixForNothing) {
  LaneCholesky<TypeParam> factor(simd::BestTarget());
  ASSERT_TRUE(factor.Analyse(1, {}));
  for (int entry = 1; entry <= 200; ++entry) {
    const auto fill = [&](TypeParam last) {
      factor.SetZero();
      for (int k = 0; k < 6; ++k) factor.diagonal(0)[7 * k] = 1;
      factor.diagonal(0)[0] = factor.diagonal(0)[1] = static_cast<TypeParam>(entry);
      factor.diagonal(0)[7] = last;
    };
    fill(static_cast<TypeParam>(entry));
    EXPECT_FALSE(factor.Factorise()) << entry;
    fill(static_cast<TypeParam>(entry) * TypeParam(1.01));
    EXPECT_TRUE(factor.Factorise()) << entry;
  }
}

template <class T>
std::vector<T> SolutionOf(const FactorGraph& graph, const MatrixXd& matrix, simd::Target target) {
  LaneCholesky<T> factor(target);
  EXPECT_TRUE(factor.Analyse(graph.nodes, graph.pairs));
  Fill(graph, 6, matrix, &factor);
  EXPECT_TRUE(factor.Factorise());
  std::vector<T> x(6 * graph.nodes, T(1));
  factor.Solve(x);
  return x;
}

TYPED_TEST(LaneCholeskyIn, GivesTheSameBitsOnEveryTarget) {
  for (const FactorGraph& graph : LaneGraphs()) {
    if (graph.nodes == 0) continue;
    SCOPED_TRACE(graph.name);
    const MatrixXd matrix = RandomMatrix(graph, 6, 1.1, 10);
    const auto expected = SolutionOf<TypeParam>(graph, matrix, simd::Target::kScalar);
    for (simd::Target target : simd::SupportedTargets()) {
      EXPECT_TRUE(SameBits(SolutionOf<TypeParam>(graph, matrix, target), expected))
          << simd::TargetName(target);
    }
  }
}

// Islands share lanes, and do not see each other.
TYPED_TEST(LaneCholeskyIn, GivesTheSameBitsBesideOtherGraphs) {
  for (const FactorGraph& graph :
       {test::ChainGraph(21), test::TreeGraph(40, 5), RingGraph(12), LadderGraph(7)}) {
    SCOPED_TRACE(graph.name);
    const MatrixXd matrix = RandomMatrix(graph, 6, 1.1, 11);
    const auto alone = SolutionOf<TypeParam>(graph, matrix, simd::BestTarget());
    // its nodes between those of a hub and a chain
    const FactorGraph hub = test::HubGraph(9), chain = test::ChainGraph(14);
    const int before = hub.nodes, after = hub.nodes + graph.nodes, all = after + chain.nodes;
    std::vector<NodePair> pairs = hub.pairs;
    for (const auto& [i, j] : graph.pairs) pairs.emplace_back(before + i, before + j);
    for (const auto& [i, j] : chain.pairs) pairs.emplace_back(after + i, after + j);
    const FactorGraph together = test::MakeFactorGraph("together", all, pairs);
    MatrixXd whole = RandomMatrix(together, 6, 1.1, 12);
    whole.block(6 * before, 6 * before, 6 * graph.nodes, 6 * graph.nodes) = matrix;
    const auto beside = SolutionOf<TypeParam>(together, whole, simd::BestTarget());
    const std::vector<TypeParam> own(beside.begin() + 6 * before, beside.begin() + 6 * after);
    EXPECT_TRUE(SameBits(own, alone));
  }
}

}  // namespace
}  // namespace cairn
