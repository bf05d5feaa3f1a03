// SPDX-License-Identifier: MIT
// What a report of a problem in matrix form says was done, and the limits that end it.
#include <gtest/gtest.h>

#include <cmath>

#include "cairn/contact_problem.h"
#include "tests/core/support/lcp_problems.h"

namespace cairn::lcp {
namespace {

using Eigen::VectorXd;
using test::LcpSolution;
using test::Planted;

Planted AnyPlanted(std::uint64_t seed) {
  test::Random random(seed);
  return test::Plant(test::RedundantMatrix(60, 1e-3, &random), {}, &random);
}

const Method kMethods[] = {Method::kPgs, Method::kPsor, Method::kPgsSm, Method::kPgsSmLiteral,
                           Method::kInteriorPoint};

TEST(LcpReport, CountsSweepsUpToTheirLimit) {
  const Planted planted = AnyPlanted(1);
  for (const Method method : {Method::kPgs, Method::kPsor}) {
    for (const int limit : {0, 1, 7, 40}) {
      Settings settings = test::MatrixSweeps(limit);
      settings.method = method;
      const Report report = test::Solve(settings, planted.problem).report;
      EXPECT_TRUE(report.ok());
      EXPECT_EQ(report.sweeps, limit);
      EXPECT_EQ(report.stop, StopReason::kSweepLimit);
      EXPECT_EQ(report.factorisations, 0);
      EXPECT_EQ(report.analyses, 0);
      EXPECT_EQ(report.factor_nonzeros, 0);
    }
  }
}

TEST(LcpReport, OfNoMethodHasMoreSweepsThanTheLimit) {
  const Planted planted = AnyPlanted(2);
  for (const Method method : kMethods) {
    for (const int limit : {0, 1, 5, 6, 23}) {
      Settings settings = test::Until(method, 1e-15);
      settings.max_sweeps = limit;
      const LcpSolution s = test::Solve(settings, planted.problem);
      EXPECT_LE(s.report.sweeps, limit);
      EXPECT_TRUE(test::InsideBox(planted.problem, s.x));
    }
  }
}

TEST(LcpReport, IsConvergedExactlyWhereTheResidualIsWithinTheTolerance) {
  const Planted planted = AnyPlanted(3);
  for (const Method method : kMethods) {
    for (const double tolerance : {1e-1, 1e-4, 1e-8}) {
      Settings settings = test::Until(method, tolerance);
      settings.max_sweeps = 200;
      const Report report = test::Solve(settings, planted.problem).report;
      // both sum the same terms, in another order
      const bool within = report.residual_relative <= tolerance * (1 + 1e-6);
      EXPECT_EQ(report.stop == StopReason::kConverged, within)
          << static_cast<int>(method) << ' ' << tolerance << ' ' << report.residual_relative;
    }
  }
}

// Dyadic: the first sweep finds the solution, the second changes nothing.
TEST(LcpReport, IsStationaryWhenASweepChangedNothing) {
  const BoxedLcp problem = test::Boxed(Eigen::Matrix2d{{2, -1}, {-1, 2}}, Eigen::Vector2d(1, -4),
                                       Eigen::Vector2d::Zero(), Eigen::Vector2d(kInfinity, 0.5));
  Settings settings = test::MatrixSweeps(1000);
  const Report report = test::Solve(settings, problem).report;
  EXPECT_EQ(report.sweeps, 2);
  EXPECT_TRUE(report.stop == StopReason::kStationary || report.stop == StopReason::kConverged);
  EXPECT_EQ(report.residual_relative, 0);
}

TEST(LcpReport, IsStationaryWhenNoRowMovedMoreThanMinProgress) {
  const Planted planted = AnyPlanted(4);
  Settings settings = test::MatrixSweeps(100'000);
  settings.min_progress = 1e-3;
  const LcpSolution s = test::Solve(settings, planted.problem);
  EXPECT_EQ(s.report.stop, StopReason::kStationary);
  EXPECT_LT(s.report.sweeps, 100'000);
  const VectorXd last = test::Solve(test::MatrixSweeps(s.report.sweeps - 1), planted.problem).x;
  EXPECT_LE((s.x - last).cwiseAbs().maxCoeff() * std::sqrt(planted.problem.M.diagonal().minCoeff()),
            1e-3);
}

// An equation needs the factor of all its rows: a chain has 2 n - 1 entries.
TEST(LcpReport, CountsFactorisationsAnalysesAndEntries) {
  const int n = 50;
  test::Sparse m(n, n);
  for (int i = 0; i < n; ++i) {
    m.insert(i, i) = 2 + 1e-3;
    if (i > 0) m.insert(i, i - 1) = m.insert(i - 1, i) = -1;
  }
  m.makeCompressed();
  test::Random random(5);
  const Planted planted = test::Plant(m, {.unbounded = 1}, &random);
  for (const Method method : {Method::kPgsSm, Method::kPgsSmLiteral, Method::kInteriorPoint}) {
    const Report report = test::Solve(test::Until(method, 1e-10), planted.problem).report;
    EXPECT_EQ(report.stop, StopReason::kConverged);
    EXPECT_EQ(report.factorisations, 1) << static_cast<int>(method);
    EXPECT_EQ(report.analyses, 1);
    EXPECT_EQ(report.factor_nonzeros, 2 * n - 1);
  }
}

// The next problem of a march has the same pattern: what was ordered and analysed serves again.
TEST(LcpReport, CountsNoAnalysisWhereTheLastPatternServes) {
  test::Random random(6);
  const test::Sparse m = test::StencilMatrix(10);
  for (const Method method : {Method::kPgsSm, Method::kPgsSmLiteral, Method::kInteriorPoint}) {
    Solver solver(test::Until(method, 1e-10));
    EXPECT_EQ(
        test::Solve(&solver, test::Plant(m, {.unbounded = 1}, &random).problem).report.analyses, 1);
    const test::Sparse next = 3 * m;
    const Report again =
        test::Solve(&solver, test::Plant(next, {.unbounded = 1}, &random).problem).report;
    EXPECT_EQ(again.analyses, 0);
    EXPECT_EQ(again.factorisations, 1);
    solver.Reset();
    EXPECT_EQ(
        test::Solve(&solver, test::Plant(m, {.unbounded = 1}, &random).problem).report.analyses, 1);
  }
}

// What a solver has kept changes nothing but the order of elimination: every answer is as good.
TEST(LcpReport, OfAUsedSolverSaysTheSameOfItsAnswers) {
  Solver solver(test::Until(Method::kPgsSm, 1e-9));
  for (std::uint64_t seed = 10; seed < 40; ++seed) {
    test::Random random(seed);
    const int side = 3 + random.Index(6);
    const test::Sparse m = seed % 2 == 0 ? test::StencilMatrix(side)
                                         : test::RedundantMatrix(side * side, 1e-3, &random);
    const Planted planted = test::Plant(m, {.degenerate = 0.1}, &random);
    solver.settings().method = seed % 3 == 0 ? Method::kInteriorPoint : Method::kPgsSm;
    const LcpSolution s = test::Solve(&solver, planted.problem);
    EXPECT_EQ(s.report.stop, StopReason::kConverged);
    EXPECT_LE(Measure(planted.problem, s.x).relative, 1.0001e-9);
  }
}

TEST(LcpReport, OfASoundProblemNamesNothingBad) {
  const Report report = test::Solve(Settings{}, AnyPlanted(7).problem).report;
  EXPECT_EQ(report.bad_row, -1);
  EXPECT_EQ(report.bad_setting.name, nullptr);
  EXPECT_EQ(Describe(report), Describe(report.stop));
}

// q = 0 has x = 0 as solution: the residual is absolute.
TEST(LcpReport, IsAbsoluteWithoutQ) {
  test::Random random(8);
  const BoxedLcp problem =
      test::Complementary(test::DominantMatrix(30, 4, &random), VectorXd::Zero(30));
  for (const Method method : kMethods) {
    const VectorXd start = VectorXd::Ones(30);
    const LcpSolution s = test::Solve(test::Until(method, 1e-10), problem, start);
    EXPECT_EQ(s.report.stop, StopReason::kConverged);
    EXPECT_EQ(s.report.residual_relative, s.report.residual_energy);
    EXPECT_LE(s.report.residual_energy, 1e-10);
    EXPECT_LE(s.x.norm(), 1e-8);
  }
}

}  // namespace
}  // namespace cairn::lcp
