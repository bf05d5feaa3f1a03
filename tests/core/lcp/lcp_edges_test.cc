// SPDX-License-Identifier: MIT
// The smallest problems, unusual boxes and unusual starts, by every method.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "cairn/contact_problem.h"
#include "tests/core/support/lcp_problems.h"

namespace cairn::lcp {
namespace {

using Eigen::VectorXd;
using test::LcpSolution;
using test::Planted;

const Method kMethods[] = {Method::kPgs, Method::kPsor, Method::kPgsSm, Method::kPgsSmLiteral,
                           Method::kInteriorPoint};

template <typename Check>
void ForEveryMethod(double tolerance, const Check& check) {
  for (const Method method : kMethods) {
    SCOPED_TRACE(static_cast<int>(method));
    Settings settings = test::Until(method, tolerance);
    settings.omega = 1.1;
    check(settings);
  }
}

TEST(LcpWithoutRows, IsSolved) {
  ForEveryMethod(1e-3, [](const Settings& settings) {
    const LcpSolution s = test::Solve(settings, BoxedLcp{});
    EXPECT_TRUE(s.report.ok());
    EXPECT_EQ(s.report.stop, StopReason::kConverged);
    EXPECT_EQ(s.x.size(), 0);
    EXPECT_EQ(s.report.factorisations, 0);
    EXPECT_EQ(s.report.residual_relative, 0);
  });
}

// Two methods called an x of 1e17 one.
TEST(LcpWithoutSolution, IsNotCalledSolved) {
  ForEveryMethod(1e-8, [](const Settings& settings) {
    const LcpSolution s = test::Solve(settings, test::WithoutSolution());
    EXPECT_NE(s.report.stop, StopReason::kConverged);
    EXPECT_GT(s.report.residual_relative, 0.1);
  });
}

struct OneRow {
  double m, q, lo, hi, x;
};

// By hand: x = clamp(-q / m, lo, hi).
TEST(LcpOfOneRow, IsSolvedByHand) {
  const OneRow rows[] = {
      {4, -8, 0, kInfinity, 2},           // inactive
      {4, 8, 0, kInfinity, 0},            // active
      {4, -8, 0, 1, 1},                   // at its upper bound
      {4, 8, -1, 1, -1},                  // at a lower bound below 0
      {4, -8, -kInfinity, kInfinity, 2},  // an equation
      {4, -8, -kInfinity, 1, 1},          // upper bound only, active
      {4, -8, -kInfinity, 3, 2},          // upper bound only, inactive
      {4, -8, 5, 7, 5},                   // both bounds above
      {4, -8, -7, -5, -5},                // both below
      {4, -8, 3, 3, 3},                   // no room
      {4, 0, 0, kInfinity, 0},            // degenerate
      {4, 0, -kInfinity, kInfinity, 0},   // q = 0
      {4, -8, 2, kInfinity, 2},           // degenerate at its bound
  };
  for (const OneRow& row : rows) {
    SCOPED_TRACE(testing::Message() << row.q << ' ' << row.lo << ' ' << row.hi);
    const auto vector = [](double value) { return VectorXd::Constant(1, value); };
    const BoxedLcp problem =
        test::Boxed(vector(row.m), vector(row.q), vector(row.lo), vector(row.hi));
    ForEveryMethod(1e-12, [&](const Settings& settings) {
      for (const double start : {0.0, -100.0, 100.0}) {
        const LcpSolution s = test::Solve(settings, problem, vector(start));
        EXPECT_TRUE(s.report.ok());
        EXPECT_EQ(s.report.stop, StopReason::kConverged);
        EXPECT_TRUE(test::InsideBox(problem, s.x));
        EXPECT_NEAR(s.x[0], row.x, 1e-11);
      }
    });
  }
}

// q >= 0: x = 0 is the solution, found without a factorisation.
TEST(Lcp, WithAllRowsActiveNeedsNoFactorisation) {
  test::Random random(1);
  const test::Sparse m = test::RedundantMatrix(40, 0, &random);
  const BoxedLcp problem = test::Complementary(m, VectorXd::LinSpaced(40, 0, 3));
  ForEveryMethod(1e-12, [&](const Settings& settings) {
    const LcpSolution s = test::Solve(settings, problem);
    EXPECT_EQ(s.report.stop, StopReason::kConverged);
    EXPECT_EQ(s.x, VectorXd::Zero(40));  // 0 or -0
    EXPECT_EQ(s.report.factorisations, 0);
    EXPECT_EQ(s.report.analyses, 0);
  });
}

/// The rows of a planted problem whose index is a multiple of three cannot move.
Planted WithFixedRows(std::uint64_t seed) {
  test::Random random(seed);
  Planted planted = test::Plant(test::DominantMatrix(45, 6, &random), {.degenerate = 0.1}, &random);
  for (int i = 0; i < 45; i += 3) {
    planted.problem.lo[i] = planted.problem.hi[i] = planted.x[i];
    planted.problem.q[i] = random.Uniform(-3, 3);  // whatever w is, it is allowed
  }
  return planted;
}

TEST(Lcp, HoldsRowsThatHaveNoRoom) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Planted planted = WithFixedRows(seed);
    ForEveryMethod(1e-11, [&](const Settings& settings) {
      const LcpSolution s = test::Solve(settings, planted.problem);
      EXPECT_TRUE(s.report.ok());
      EXPECT_EQ(s.report.stop, StopReason::kConverged);
      EXPECT_TRUE(test::InsideBox(planted.problem, s.x));
      const double residuals =
          test::MostResidual(planted.problem, s.x) + test::MostResidual(planted.problem, planted.x);
      EXPECT_LE(test::EnergyOfX(planted.problem, s.x - planted.x),
                test::MostApart(test::ScaledSpectrum(planted.problem), residuals));
    });
  }
}

// An interior point method never sees the bounds of such rows, and must not move them either: every
// iterate is inside the box.
TEST(InteriorPoint, ShowsIteratesInsideABoxWithRowsThatHaveNoRoom) {
  const Planted planted = WithFixedRows(11);
  Solver solver(test::Until(Method::kInteriorPoint, 1e-11));
  int factorisations = 0;
  solver.Observe([&](const Iterate& iterate) {
    EXPECT_TRUE(test::InsideBox(planted.problem, iterate.x));
    factorisations = iterate.factorisations;
    return true;
  });
  EXPECT_EQ(test::Solve(&solver, planted.problem).report.stop, StopReason::kConverged);
  EXPECT_GT(factorisations, 2);
}

TEST(Lcp, WithoutRoomAnywhereIsSolvedAtOnce) {
  test::Random random(2);
  BoxedLcp problem = test::Plant(test::DominantMatrix(20, 4, &random), {}, &random).problem;
  problem.lo = problem.hi = VectorXd::LinSpaced(20, -1, 1);
  ForEveryMethod(1e-12, [&](const Settings& settings) {
    const LcpSolution s = test::Solve(settings, problem);
    EXPECT_EQ(s.report.stop, StopReason::kConverged);
    EXPECT_TRUE(test::SameBits(s.x, problem.lo));
  });
}

// A string over a floor, pulled up on its first half and down on its second: it lifts more than 1e4
// times what one point alone asks for. From a start of that size steps are short and lead nowhere.
TEST(InteriorPoint, FindsASolutionFarLargerThanItsStart) {
  constexpr int kPoints = 1000;
  Eigen::SparseMatrix<double> m(kPoints, kPoints);
  VectorXd q(kPoints);
  for (int i = 0; i < kPoints; ++i) {
    m.insert(i, i) = 2;
    if (i > 0) m.insert(i - 1, i) = m.insert(i, i - 1) = -1;
    q[i] = -std::sin(2 * std::numbers::pi * (i + 1) / (kPoints + 1));
  }
  const BoxedLcp problem = test::Complementary(m, q);
  const LcpSolution s = test::Solve(test::Until(Method::kInteriorPoint, 1e-9), problem);
  EXPECT_EQ(s.report.stop, StopReason::kConverged);
  EXPECT_LE(s.report.residual_relative, 1e-9);
  EXPECT_GT(s.x.maxCoeff(), 1e4);
}

// Boxes of one to a thousand roundings: nothing fits between, and nothing may divide by it.
TEST(Lcp, SurvivesBoxesAsNarrowAsRounding) {
  test::Random random(3);
  const Planted planted = test::Plant(test::DominantMatrix(40, 6, &random), {}, &random);
  for (const double offset : {0.0, 1.0, 1e9}) {
    BoxedLcp problem = planted.problem;
    for (int i = 0; i < 40; i += 2) {
      problem.lo[i] = offset + i;
      problem.hi[i] = problem.lo[i];
      for (int k = 0; k < (i % 4 == 0 ? 1 : 1000); ++k) {
        problem.hi[i] = std::nextafter(problem.hi[i], kInfinity);
      }
    }
    ForEveryMethod(1e-12, [&](Settings settings) {
      settings.max_sweeps = 2000;
      const LcpSolution s = test::Solve(settings, problem);
      EXPECT_TRUE(s.report.ok());
      EXPECT_TRUE(test::InsideBox(problem, s.x));
      const double q = test::EnergyOfW(problem, problem.q);
      EXPECT_LE(Measure(problem, s.x).energy, 1e-12 * q + test::RoundingOfW(problem, s.x));
    });
  }
}

// A tolerance that rounding cannot reach: the iteration still ends, with the best of its iterates.
TEST(Lcp, EndsWhereRoundingDecides) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    test::Random random(seed);
    const test::Sparse m = test::RedundantMatrix(60, 1e-3, &random);
    const Planted planted = test::Plant(m, {.degenerate = 0.5}, &random);
    for (const Method method : {Method::kPgsSm, Method::kInteriorPoint}) {
      SCOPED_TRACE(static_cast<int>(method));
      const LcpSolution s = test::Solve(test::Until(method, 0), planted.problem);
      EXPECT_TRUE(s.report.ok());
      EXPECT_LT(s.report.sweeps, 1000);
      EXPECT_LT(s.report.factorisations, 200);
      EXPECT_LE(s.report.residual_relative, 1e-11);
      EXPECT_TRUE(test::InsideBox(planted.problem, s.x));
    }
  }
}

TEST(WarmStart, AtTheSolutionStaysThere) {
  for (const double degenerate : {0.0, 0.5}) {
    test::Random random(4);
    const Planted planted =
        test::Plant(test::DominantMatrix(60, 6, &random), {.degenerate = degenerate}, &random);
    ForEveryMethod(1e-10, [&](const Settings& settings) {
      const LcpSolution s = test::Solve(settings, planted.problem, planted.x);
      EXPECT_EQ(s.report.stop, StopReason::kConverged);
      EXPECT_EQ(s.report.factorisations, 0);
      EXPECT_LE(s.report.sweeps, settings.k_gs);
      // sweeps contract towards the solution, which is a rounding away
      EXPECT_LE((s.x - planted.x).cwiseAbs().maxCoeff(), 1e-13);
    });
  }
}

// Sweeps relax from the projected start: nothing else of it is seen.
TEST(WarmStart, OutsideTheBoxIsBroughtInsideFirst) {
  test::Random random(5);
  const Planted planted = test::Plant(test::DominantMatrix(60, 6, &random), {}, &random);
  VectorXd start(60);
  for (double& entry : start) entry = random.Uniform(-1e6, 1e6);
  const VectorXd inside = start.cwiseMax(planted.problem.lo).cwiseMin(planted.problem.hi);
  ASSERT_FALSE(test::InsideBox(planted.problem, start));
  ForEveryMethod(1e-10, [&](const Settings& settings) {
    const LcpSolution s = test::Solve(settings, planted.problem, start);
    EXPECT_EQ(s.report.stop, StopReason::kConverged);
    EXPECT_TRUE(test::SameBits(s.x, test::Solve(settings, planted.problem, inside).x));
  });
  Settings none = test::MatrixSweeps(0);
  EXPECT_TRUE(test::SameBits(test::Solve(none, planted.problem, start).x, inside));
}

// Method::kPgsSm without steps is Method::kPgs.
TEST(PgsSm, WithoutStepsIsPlainSweeps) {
  test::Random random(6);
  const Planted planted = test::Plant(test::DominantMatrix(60, 6, &random), {}, &random);
  const LcpSolution sweeps = test::Solve(test::Until(Method::kPgs, 1e-8), planted.problem);
  for (const Method method : {Method::kPgsSm, Method::kPgsSmLiteral}) {
    Settings settings = test::Until(method, 1e-8);
    settings.k_sm = 0;
    const LcpSolution s = test::Solve(settings, planted.problem);
    EXPECT_TRUE(test::SameBits(s.x, sweeps.x));
    EXPECT_EQ(s.report.sweeps, sweeps.report.sweeps);
    EXPECT_EQ(s.report.factorisations, 0);
  }
}

}  // namespace
}  // namespace cairn::lcp
