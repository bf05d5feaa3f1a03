// SPDX-License-Identifier: MIT
// The interior point iterations by themselves.
#include "core/lcp/src/methods/barrier.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <vector>

#include "runtime/own_threads.h"
#include "tests/core/support/lcp_problems.h"

namespace cairn::lcp {
namespace {

using Eigen::VectorXd;
using test::Planted;

/// What a barrier works on.
class Bench {
 public:
  explicit Bench(const BoxedLcp& problem)
      : meter_(Budget::Unlimited(), 0, &prices_),
        crew_(1),
        state_(problem, settings_, &meter_, &crew_, observer_) {
    factor_.Attach(problem.M);
    state_.x = VectorXd::Zero(problem.size());
    Clamp(problem, &state_.x);
  }

  LcpState* state() { return &state_; }
  SparseCholesky* factor() { return &factor_; }

 private:
  Settings settings_{.tolerance = 0};
  WorkPrices prices_;
  BudgetMeter meter_;
  Crew crew_;
  Observer observer_;
  LcpState state_;
  SparseCholesky factor_;
};

Planted AnyPlanted(std::uint64_t seed) {
  test::Random random(seed);
  return test::Plant(test::RedundantMatrix(60, 1e-3, &random), {.unbounded = 0.1}, &random);
}

/// Where the planted solution is: w tells a row at its bound from one that only touches it.
RowSet PlantedSet(const Planted& planted) {
  RowSet set(planted.x.size(), Side::kFree);
  for (Eigen::Index i = 0; i < planted.x.size(); ++i) {
    if (planted.w[i] > 0) set[i] = Side::kLower;
    if (planted.w[i] < 0) set[i] = Side::kUpper;
  }
  return set;
}

// Interior point methods take 10 to 30 iterations whatever the problem.
TEST(Barrier, ComesDownToRoundingInFewSteps) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Planted planted = AnyPlanted(seed);
    Bench bench(planted.problem);
    Barrier barrier(bench.state(), bench.factor(), bench.state()->x);
    int steps = 0;
    while (steps < 40 && Measure(planted.problem, barrier.Rounded()).relative > 1e-11) {
      ASSERT_TRUE(barrier.Fits());
      ASSERT_TRUE(barrier.Step());
      ++steps;
    }
    EXPECT_LE(steps, 30) << seed;
    EXPECT_EQ(bench.state()->factorisations(), steps);
    // no degenerate rows: the solution names its set
    EXPECT_EQ(barrier.Predicted(), PlantedSet(planted)) << seed;
  }
}

TEST(Barrier, StaysInsideTheBox) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Planted planted = AnyPlanted(seed);
    Bench bench(planted.problem);
    Barrier barrier(bench.state(), bench.factor(), bench.state()->x);
    for (int step = 0; step < 12; ++step) {
      // near the end the slack is less than a rounding of the bound
      EXPECT_TRUE(test::InsideBox(planted.problem, barrier.x()));
      if (step < 4) {
        EXPECT_TRUE((barrier.x().array() > planted.problem.lo.array()).all());
        EXPECT_TRUE((barrier.x().array() < planted.problem.hi.array()).all());
      }
      EXPECT_TRUE(test::InsideBox(planted.problem, barrier.Rounded()));
      ASSERT_TRUE(barrier.Step());
      EXPECT_GT(barrier.step_length(), 0);
      EXPECT_LE(barrier.step_length(), 1);
    }
  }
}

// Without bounds an iteration is a linear solve.
TEST(Barrier, SolvesEquationsInOneStep) {
  test::Random random(11);
  const test::Sparse m = test::RedundantMatrix(50, 1e-2, &random);
  const Planted planted = test::Plant(m, {.unbounded = 1}, &random);
  Bench bench(planted.problem);
  Barrier barrier(bench.state(), bench.factor(), bench.state()->x);
  ASSERT_TRUE(barrier.Step());
  EXPECT_DOUBLE_EQ(barrier.step_length(), 1);
  EXPECT_LE(Measure(planted.problem, barrier.x()).relative, 1e-13);
}

// Rows whose bounds meet are no unknowns: not one bit of them moves.
TEST(Barrier, DoesNotMoveRowsThatHaveNoRoom) {
  Planted planted = AnyPlanted(12);
  BoxedLcp& problem = planted.problem;
  for (int i = 0; i < 60; i += 4) problem.lo[i] = problem.hi[i] = planted.x[i];
  Bench bench(problem);
  Barrier barrier(bench.state(), bench.factor(), bench.state()->x);
  for (int step = 0; step < 5; ++step) {
    ASSERT_TRUE(barrier.Step());
    for (int i = 0; i < 60; i += 4) {
      EXPECT_EQ(barrier.x()[i], planted.x[i]) << "row " << i << " step " << step;
      EXPECT_EQ(barrier.Rounded()[i], planted.x[i]);
      EXPECT_EQ(barrier.Predicted()[i], Side::kLower);
    }
  }
}

TEST(Barrier, SaysThatAMatrixIsIndefinite) {
  const Eigen::Matrix2d m{{1, 2}, {2, 1}};
  const BoxedLcp problem =
      test::Boxed(m, Eigen::Vector2d(-1, -1), Eigen::Vector2d::Constant(-kInfinity),
                  Eigen::Vector2d::Constant(kInfinity));
  Bench bench(problem);
  Barrier barrier(bench.state(), bench.factor(), bench.state()->x);
  EXPECT_FALSE(barrier.Step());
}

// A sum that has come down to rounding does not count as progress for ever.
TEST(Barrier, StopsAdvancing) {
  const Planted planted = AnyPlanted(13);
  Bench bench(planted.problem);
  Barrier barrier(bench.state(), bench.factor(), bench.state()->x);
  int steps = 0;
  bool advances = true;
  while (advances && steps < 200) {
    ASSERT_TRUE(barrier.Step());
    advances = barrier.Advances(Measure(planted.problem, barrier.Rounded()).relative);
    ++steps;
  }
  EXPECT_GT(steps, 8);
  EXPECT_LT(steps, 60);
}

}  // namespace
}  // namespace cairn::lcp
