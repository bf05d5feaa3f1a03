// SPDX-License-Identifier: MIT
// A pattern that is analysed is factorised and solved with without allocating. A program of its
// own, with an operator new that counts.
#include <gtest/gtest.h>

#include <vector>

#include "cholesky/front_cholesky.h"
#include "cholesky/lane_cholesky.h"
#include "runtime/crew.h"
#include "tests/core/support/factor_graphs.h"
#include "tests/core/support/watched_new.h"

namespace cairn {
namespace {

template <class T>
void ExpectNoneAfterAnalysis() {
  for (const test::FactorGraph& graph : {test::GridGraph(7, 7, 6), test::TreeGraph(50, 1)}) {
    Crew crew(2);
    FrontCholesky<T> factor(simd::BestTarget());
    long before = test::NewCalls();
    factor.Analyse(graph.nodes, 6, graph.pairs);
    EXPECT_GT(test::NewCalls(), before) << "counts nothing";
    std::vector<T> x(6 * graph.nodes, T(1));
    crew.Call();

    before = test::NewCalls();
    bool fits = true;
    for (int repetition = 0; repetition < 3; ++repetition) {
      factor.SetZero();
      for (int node = 0; node < graph.nodes; ++node) {
        for (int k = 0; k < 6; ++k) factor.diagonal(node)[7 * k] = T(2);
      }
      fits = factor.Factorise() && factor.Factorise(&crew) && fits;
      factor.Solve(x);
    }
    const long after = test::NewCalls();
    crew.Dismiss();
    EXPECT_TRUE(fits);
    EXPECT_EQ(after, before);
  }
}

template <class T>
void ExpectNoneInLanes() {
  const test::FactorGraph graph = test::TreeGraph(50, 1);
  LaneCholesky<T> factor(simd::BestTarget());
  ASSERT_TRUE(factor.Analyse(graph.nodes, graph.pairs));
  std::vector<T> x(6 * graph.nodes, T(1));
  const long before = test::NewCalls();
  factor.SetZero();
  for (int node = 0; node < graph.nodes; ++node) {
    for (int k = 0; k < 6; ++k) factor.diagonal(node)[7 * k] = T(2);
  }
  const bool fits = factor.Factorise();
  factor.Solve(x);
  const long after = test::NewCalls();
  EXPECT_TRUE(fits);
  EXPECT_EQ(after, before);
}

TEST(FactorNoAlloc, OfATreeInLanes) {
  ExpectNoneInLanes<float>();
  ExpectNoneInLanes<double>();
}

TEST(FactorNoAlloc, OfAPatternThatIsAnalysed) {
  ExpectNoneAfterAnalysis<float>();
  ExpectNoneAfterAnalysis<double>();
}

}  // namespace
}  // namespace cairn
