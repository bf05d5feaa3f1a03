// SPDX-License-Identifier: MIT
// The sparse factor against the dense one of Eigen, and against itself on other targets and with
// more threads.
#include "cholesky/front_cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <limits>
#include <vector>

#include "runtime/crew.h"
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

template <class T>
void ExpectSolves(const FactorGraph& graph, int node_size, FrontCholesky<T>* factor,
                  std::uint64_t seed) {
  // dominant: the condition is a few hundred at most with these rows
  const MatrixXd matrix = RandomMatrix(graph, node_size, 1.1, seed);
  Fill(graph, node_size, matrix, factor);
  ASSERT_TRUE(factor->Factorise());
  const std::vector<double> rhs = RandomVector(graph.nodes * node_size);
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

template <class T>
class FrontCholeskyIn : public testing::Test {};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(FrontCholeskyIn, Numbers);

TYPED_TEST(FrontCholeskyIn, SolvesWhatTheDenseFactorSolves) {
  FrontCholesky<TypeParam> factor(simd::BestTarget());  // one for all
  for (int node_size : {1, 6, 3}) {
    for (const FactorGraph& graph : test::FactorGraphs()) {
      SCOPED_TRACE(testing::Message() << graph.name << ", nodes of " << node_size);
      factor.Analyse(graph.nodes, node_size, graph.pairs);
      for (std::uint64_t seed : {1, 2}) ExpectSolves(graph, node_size, &factor, seed);
    }
  }
}

TYPED_TEST(FrontCholeskyIn, LeavesTheMatrixAsItIs) {
  const FactorGraph graph = test::GridGraph(4, 4, 2);
  FrontCholesky<TypeParam> factor(simd::BestTarget());
  factor.Analyse(graph.nodes, 6, graph.pairs);
  Fill(graph, 6, RandomMatrix(graph, 6, 1.1, 3), &factor);
  std::vector<TypeParam> first(6 * graph.nodes, 1), second = first;
  ASSERT_TRUE(factor.Factorise());
  factor.Solve(first);
  ASSERT_TRUE(factor.Factorise());
  factor.Solve(second);
  EXPECT_EQ(first, second);
}

TYPED_TEST(FrontCholeskyIn, DoesNotMindPairsWithoutNumbers) {
  const FactorGraph all = test::RandomGraph(40, 120, 4), some = test::RandomGraph(40, 60, 5);
  std::vector<NodePair> pairs = all.pairs;
  pairs.insert(pairs.end(), some.pairs.begin(), some.pairs.end());
  const FactorGraph superset = test::MakeFactorGraph("superset", 40, pairs);
  const MatrixXd matrix = RandomMatrix(some, 6, 1.1, 6);
  FrontCholesky<TypeParam> factor(simd::BestTarget());
  factor.Analyse(40, 6, superset.pairs);
  Fill(superset, 6, matrix, &factor);
  ASSERT_TRUE(factor.Factorise());
  const std::vector<double> rhs = RandomVector(240);
  std::vector<TypeParam> x(rhs.begin(), rhs.end());
  factor.Solve(x);
  const VectorXd expected = matrix.llt().solve(Eigen::Map<const VectorXd>(rhs.data(), 240));
  for (int i = 0; i < 240; ++i) {
    EXPECT_NEAR(x[i], expected[i],
                100 * std::numeric_limits<TypeParam>::epsilon() * expected.cwiseAbs().maxCoeff());
  }
}

TYPED_TEST(FrontCholeskyIn, SaysWhenTheMatrixIsNotPositiveDefinite) {
  for (const FactorGraph& graph :
       {test::ChainGraph(8), test::HubGraph(8), test::CliqueGraph(8), test::GridGraph(6, 6, 1)}) {
    SCOPED_TRACE(graph.name);
    FrontCholesky<TypeParam> factor(simd::BestTarget());
    factor.Analyse(graph.nodes, 6, graph.pairs);
    const MatrixXd indefinite = RandomMatrix(graph, 6, 0.05, 7);
    ASSERT_EQ(indefinite.llt().info(), Eigen::NumericalIssue);
    Fill(graph, 6, indefinite, &factor);
    EXPECT_FALSE(factor.Factorise());
    ExpectSolves(graph, 6, &factor, 8);  // and recovers
    factor.diagonal(3)[7] = std::numeric_limits<TypeParam>::quiet_NaN();
    EXPECT_FALSE(factor.Factorise());
    ExpectSolves(graph, 6, &factor, 9);
    factor.upper(0)[0] = std::numeric_limits<TypeParam>::infinity();
    EXPECT_FALSE(factor.Factorise());
    factor.SetZero();
    EXPECT_FALSE(factor.Factorise());
  }
}

// Two equal rows: what is left of the second pivot is rounding, with either sign (49 - 49 (49 / 49)
// is positive in double, 41 in float).
TYPED_TEST(FrontCholeskyIn, TakesRoundingOfASingularMatrixForNothing) {
  FrontCholesky<TypeParam> factor(simd::BestTarget());
  const std::vector<NodePair> pairs = {{0, 1}};
  factor.Analyse(2, 1, pairs);
  for (int entry = 1; entry <= 200; ++entry) {
    *factor.diagonal(0) = *factor.diagonal(1) = *factor.upper(0) = static_cast<TypeParam>(entry);
    EXPECT_FALSE(factor.Factorise()) << entry;
    *factor.diagonal(1) *= TypeParam(1.01);
    EXPECT_TRUE(factor.Factorise()) << entry;
  }
}

/// Solutions of one system, the way it is factorised given.
template <class T>
std::vector<T> SolutionBy(const FactorGraph& graph, const MatrixXd& matrix, int node_size,
                          simd::Target target, Crew* crew) {
  FrontCholesky<T> factor(target);
  factor.Analyse(graph.nodes, node_size, graph.pairs);
  Fill(graph, node_size, matrix, &factor);
  EXPECT_TRUE(factor.Factorise(crew));
  std::vector<T> x(graph.nodes * node_size, T(1));
  factor.Solve(x);
  return x;
}

TYPED_TEST(FrontCholeskyIn, GivesTheSameBitsOnEveryTarget) {
  for (int node_size : {1, 6}) {
    for (const FactorGraph& graph : test::FactorGraphs()) {
      if (graph.nodes == 0) continue;
      SCOPED_TRACE(graph.name);
      const MatrixXd matrix = RandomMatrix(graph, node_size, 1.1, 10);
      const auto expected =
          SolutionBy<TypeParam>(graph, matrix, node_size, simd::Target::kScalar, nullptr);
      for (simd::Target target : simd::SupportedTargets()) {
        const auto actual = SolutionBy<TypeParam>(graph, matrix, node_size, target, nullptr);
        EXPECT_TRUE(SameBits(actual, expected)) << simd::TargetName(target);
      }
    }
  }
}

TYPED_TEST(FrontCholeskyIn, GivesTheSameBitsWithAnyNumberOfThreads) {
  // enough work for threads: one front, a tree of many, and many trees
  FactorGraph many = test::ChainGraph(0);
  for (int k = 0; k < 40; ++k) {
    for (const auto& [i, j] : test::CliqueGraph(10).pairs) {
      many.pairs.emplace_back(10 * k + i, 10 * k + j);
    }
  }
  many.nodes = 400;
  for (const FactorGraph& graph :
       {test::CliqueGraph(40), test::GridGraph(7, 7, 6), test::GridGraph(40, 12, 1), many}) {
    SCOPED_TRACE(testing::Message() << graph.name << " of " << graph.nodes);
    const MatrixXd matrix = RandomMatrix(graph, 6, 1.1, 11);
    const auto expected = SolutionBy<TypeParam>(graph, matrix, 6, simd::BestTarget(), nullptr);
    for (int threads : {1, 2, 3, 8}) {
      Crew crew(threads);
      for (int repetition = 0; repetition < 5; ++repetition) {
        const auto actual = SolutionBy<TypeParam>(graph, matrix, 6, simd::BestTarget(), &crew);
        EXPECT_TRUE(SameBits(actual, expected)) << threads << " threads";
      }
    }
  }
}

TYPED_TEST(FrontCholeskyIn, SaysSoWithThreadsToo) {
  const FactorGraph graph = test::GridGraph(7, 7, 6);
  FrontCholesky<TypeParam> factor(simd::BestTarget());
  factor.Analyse(graph.nodes, 6, graph.pairs);
  ASSERT_GT(factor.pattern().flops(), 2e6);
  const MatrixXd matrix = RandomMatrix(graph, 6, 1.1, 12);
  Crew crew(3);
  for (int node : {0, 100, 150, 200, 293}) {
    Fill(graph, 6, matrix, &factor);
    factor.diagonal(node)[0] = -1;
    EXPECT_FALSE(factor.Factorise(&crew)) << node;
    Fill(graph, 6, matrix, &factor);
    EXPECT_TRUE(factor.Factorise(&crew)) << node;
  }
}

}  // namespace
}  // namespace cairn
