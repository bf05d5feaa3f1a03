// SPDX-License-Identifier: MIT
// Budgets of problems in matrix form.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "tests/core/support/lcp_problems.h"

namespace cairn::lcp {
namespace {

using Eigen::VectorXd;
using std::chrono::nanoseconds;
using test::LcpSolution;
using test::Planted;

Planted AnyPlanted(std::uint64_t seed) {
  test::Random random(seed);
  return test::Plant(test::RedundantMatrix(120, 1e-4, &random), {}, &random);
}

Settings Within(Method method, Budget budget) {
  Settings settings = test::Until(method, 1e-15);
  settings.order = SweepOrder::kForward;
  settings.budget = budget;
  return settings;
}

const Method kMethods[] = {Method::kPgs, Method::kPsor, Method::kPgsSm, Method::kPgsSmLiteral,
                           Method::kInteriorPoint};

/// A look at the residual costs so many sweeps at most.
constexpr int kLook = 2;

// A step begins only if it and a sweep fit. What follows the last sweep is one look at the iterate.
// A singular matrix is factorised again with a larger shift: not here.
TEST(LcpWork, ExceedsTheBudgetByASweepAndALookAtTheResidual) {
  const Planted planted = AnyPlanted(1);
  const std::int64_t n = planted.problem.size();
  int steps = 0;
  for (const Method method : kMethods) {
    for (std::int64_t work = 1; work < 100 * n; work += 3 * n / 2) {
      const Report report = test::Solve(Within(method, Budget::Work(work)), planted.problem).report;
      EXPECT_LE(report.work, work + (1 + kLook) * n) << static_cast<int>(method);
      EXPECT_GT(report.elapsed, nanoseconds(0));
      steps += report.factorisations;
      if (report.stop == StopReason::kWorkSpent) continue;
      EXPECT_TRUE(report.stop == StopReason::kStalled || report.stop == StopReason::kConverged);
    }
  }
  EXPECT_GT(steps, 20);
}

TEST(LcpWork, GivesTheSameBitsTwice) {
  const Planted planted = AnyPlanted(2);
  for (const Method method : kMethods) {
    for (const int work : {100, 3000, 30000}) {
      const Settings settings = Within(method, Budget::Work(work));
      const LcpSolution first = test::Solve(settings, planted.problem);
      const LcpSolution second = test::Solve(settings, planted.problem);
      EXPECT_TRUE(test::SameBits(first.x, second.x));
      EXPECT_EQ(first.report.work, second.report.work);
    }
  }
}

// Sweeps never raise the objective, so neither does more work.
TEST(LcpWork, MoreOfItNeverLeavesAHigherObjectiveAfterSweeps) {
  const Planted planted = AnyPlanted(3);
  const int n = static_cast<int>(planted.problem.size());
  const VectorXd zero = VectorXd::Zero(n);
  const VectorXd start = zero.cwiseMax(planted.problem.lo).cwiseMin(planted.problem.hi);
  const double first = Measure(planted.problem, start).objective;
  double last = first;
  for (int work = n; work < 60 * n; work += n) {
    const LcpSolution s = test::Solve(Within(Method::kPgs, Budget::Work(work)), planted.problem);
    const double now = Measure(planted.problem, s.x).objective;
    EXPECT_LE(now, last + 1e-13 * std::abs(first));
    last = now;
  }
  EXPECT_LT(last, first - 0.1 * std::abs(first));
}

// Too little for any factorisation of a full matrix: what can be done is sweeps.
TEST(LcpWork, TooSmallForAFactorisationIsSpentOnSweeps) {
  test::Random random(4);
  const Planted planted =
      test::Plant(test::DominantMatrix(100, 150, &random), {.unbounded = 0.8}, &random);
  const Method methods[] = {Method::kPgsSm, Method::kPgsSmLiteral, Method::kInteriorPoint};
  const double before = Measure(planted.problem, VectorXd::Zero(100)).objective;
  for (const Method method : methods) {
    SCOPED_TRACE(static_cast<int>(method));
    const LcpSolution s = test::Solve(Within(method, Budget::Work(1200)), planted.problem);
    EXPECT_EQ(s.report.stop, StopReason::kWorkSpent);
    EXPECT_EQ(s.report.factorisations, 0);
    EXPECT_GE(s.report.sweeps, 5);
    EXPECT_LT(Measure(planted.problem, s.x).objective, before);
    EXPECT_LT(s.report.residual_relative, 0.1);
  }
}

// Settings::min_sweeps are made in any case, and no more.
TEST(LcpBudget, OfNothingMakesTheSweepsThatAreMadeInAnyCase) {
  const Planted planted = AnyPlanted(5);
  for (const int sweeps : {0, 1, 3}) {
    const LcpSolution expected = test::Solve(test::MatrixSweeps(sweeps), planted.problem);
    for (const Budget& nothing : {Budget::Work(0), Budget::Time(nanoseconds(0))}) {
      for (const Method method : {Method::kPgs, Method::kPgsSm, Method::kInteriorPoint}) {
        SCOPED_TRACE(static_cast<int>(method));
        Settings settings = Within(method, nothing);
        settings.min_sweeps = sweeps;
        const LcpSolution s = test::Solve(settings, planted.problem);
        EXPECT_EQ(s.report.sweeps, sweeps);
        EXPECT_TRUE(test::SameBits(s.x, expected.x));
      }
    }
  }
}

TEST(LcpBudget, OfNoTimeGivesAPointInsideTheBox) {
  const Planted planted = AnyPlanted(6);
  const VectorXd start = VectorXd::LinSpaced(planted.problem.size(), -50, 50);
  for (const Method method : kMethods) {
    const Settings settings = Within(method, Budget::Time(nanoseconds(0)));
    const LcpSolution s = test::Solve(settings, planted.problem, start);
    EXPECT_TRUE(s.report.ok());
    EXPECT_EQ(s.report.stop, StopReason::kTimeSpent);
    EXPECT_EQ(s.report.factorisations, 0);
    EXPECT_TRUE(test::InsideBox(planted.problem, s.x));
  }
}

TEST(LcpBudget, ThatIsNeverSpentChangesNothing) {
  const Planted planted = AnyPlanted(7);
  for (const Method method : kMethods) {
    SCOPED_TRACE(static_cast<int>(method));
    Settings settings = Within(method, Budget::Unlimited());
    settings.tolerance = 1e-8;
    settings.max_sweeps = 500;
    const LcpSolution unlimited = test::Solve(settings, planted.problem);
    EXPECT_GT(unlimited.report.elapsed, nanoseconds(0));
    for (const Budget& plenty :
         {Budget::Work(1'000'000'000'000), Budget::Time(std::chrono::hours(24))}) {
      settings.budget = plenty;
      const LcpSolution s = test::Solve(settings, planted.problem);
      EXPECT_TRUE(test::SameBits(unlimited.x, s.x));
      EXPECT_EQ(s.report.work, unlimited.report.work);
      EXPECT_EQ(s.report.stop, unlimited.report.stop);
      EXPECT_GT(s.report.elapsed, nanoseconds(0));
    }
  }
}

// A sweep costs its rows, and so does the look at the residual that ends the iteration.
TEST(LcpWork, OfSweepsIsTheirRows) {
  const Planted planted = AnyPlanted(8);
  const std::int64_t n = planted.problem.size();
  for (const int sweeps : {1, 10, 33}) {
    const Report report = test::Solve(test::MatrixSweeps(sweeps), planted.problem).report;
    EXPECT_GE(report.work, sweeps * n);
    EXPECT_LE(report.work, (sweeps + kLook) * n);
  }
}

}  // namespace
}  // namespace cairn::lcp
