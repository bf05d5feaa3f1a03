// SPDX-License-Identifier: MIT
// Every method against solutions that were planted.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <string>
#include <vector>

#include "cairn/contact_problem.h"
#include "tests/core/support/lcp_problems.h"

namespace cairn::lcp {
namespace {

using Eigen::VectorXd;
using test::LcpSolution;
using test::Planted;
using test::PlantOptions;
using test::Sparse;

constexpr double kTolerance = 1e-10;
const double kDegenerateShares[] = {0, 0.1, 0.5};

/// Converged, and as near to the planted solution as two such residuals imply.
void ExpectPlanted(const Planted& planted, const LcpSolution& s) {
  const BoxedLcp& problem = planted.problem;
  ASSERT_TRUE(s.report.ok());
  EXPECT_EQ(s.report.stop, StopReason::kConverged);
  EXPECT_TRUE(test::InsideBox(problem, s.x));
  const LcpResidual reached = Measure(problem, s.x), truth = Measure(problem, planted.x);
  EXPECT_LE(reached.relative, 2 * kTolerance);
  EXPECT_LE(truth.relative, 1e-14);  // rounding of q = w - M x

  const test::Spectrum spectrum = test::ScaledSpectrum(problem);
  const double apart = test::EnergyOfX(problem, s.x - planted.x);
  const double most = test::MostApart(
      spectrum, test::MostResidual(problem, s.x) + test::MostResidual(problem, planted.x));
  EXPECT_LE(apart, most);
  // the bound says something: the start, zeros, is outside it
  EXPECT_LT(most, 1e-2 * test::EnergyOfX(problem, planted.x));

  const VectorXd w = problem.M * s.x + problem.q;
  const double rounding = test::RoundingOfW(problem, s.x) + test::RoundingOfW(problem, planted.x);
  EXPECT_LE(test::EnergyOfW(problem, w - planted.w), spectrum.most * most + rounding);
}

/// The same for 30 problems of each share of degenerate rows.
template <typename MakeMatrix>
void ExpectPlantedFor(const std::vector<Settings>& methods, const MakeMatrix& make_matrix) {
  for (const double degenerate : kDegenerateShares) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      test::Random random(seed);
      const Sparse m = make_matrix(&random);
      const Planted planted = test::Plant(m, {.degenerate = degenerate}, &random);
      for (const Settings& settings : methods) {
        SCOPED_TRACE("method " + std::to_string(static_cast<int>(settings.method)) + " omega " +
                     std::to_string(settings.omega) + " degenerate " + std::to_string(degenerate) +
                     " seed " + std::to_string(seed));
        ExpectPlanted(planted, test::Solve(settings, planted.problem));
      }
    }
  }
}

std::vector<Settings> AllMethods() {
  Settings over = test::Until(Method::kPsor, kTolerance), under = over;
  over.omega = 1.3;
  under.omega = 0.8;
  return {test::Until(Method::kPgs, kTolerance),
          over,
          under,
          test::Until(Method::kPgsSm, kTolerance),
          test::Until(Method::kPgsSmLiteral, kTolerance),
          test::Until(Method::kInteriorPoint, kTolerance)};
}

std::vector<Settings> RobustMethods() {
  return {test::Until(Method::kPgsSm, kTolerance), test::Until(Method::kInteriorPoint, kTolerance)};
}

TEST(EveryMethod, FindsPlantedSolutionsOfDominantMatrices) {
  ExpectPlantedFor(AllMethods(),
                   [](test::Random* random) { return test::DominantMatrix(60, 6, random); });
}

TEST(EveryMethod, FindsPlantedSolutionsOnAGrid) {
  ExpectPlantedFor(AllMethods(), [](test::Random*) { return test::StencilMatrix(9); });
}

// Twice as many rows as degrees of freedom: sweeps would need a share of 1 / compliance of them.
TEST(RobustMethods, FindPlantedSolutionsOfRedundantRows) {
  for (const double compliance : {1e-2, 1e-5}) {
    ExpectPlantedFor(RobustMethods(), [compliance](test::Random* random) {
      return test::RedundantMatrix(60, compliance, random);
    });
  }
}

// x is not unique, w is.
TEST(RobustMethods, FindTheSlackOfSingularProblems) {
  for (const double degenerate : kDegenerateShares) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      test::Random random(seed);
      const Sparse m = test::RedundantMatrix(60, 0, &random);
      const Planted planted = test::Plant(m, {.degenerate = degenerate}, &random);
      ASSERT_LT(test::ScaledSpectrum(planted.problem).least, 1e-14);
      for (const Settings& settings :
           {test::Until(Method::kPgsSm, 1e-9), test::Until(Method::kInteriorPoint, 1e-9)}) {
        SCOPED_TRACE(static_cast<int>(settings.method));
        SCOPED_TRACE(seed);
        const LcpSolution s = test::Solve(settings, planted.problem);
        ASSERT_TRUE(s.report.ok());
        EXPECT_EQ(s.report.stop, StopReason::kConverged);
        EXPECT_TRUE(test::InsideBox(planted.problem, s.x));
        const VectorXd w = planted.problem.M * s.x + planted.problem.q;
        const double apart = test::EnergyOfW(planted.problem, w - planted.w);
        EXPECT_LE(apart, 1e-8 * test::EnergyOfW(planted.problem, planted.problem.q));
      }
    }
  }
}

Settings OneStep() { return test::Until(Method::kPgsSm, 1e-12); }

// Only equations: a linear system, and one factorisation solves it.
TEST(PgsSm, SolvesEquationsWithOneFactorisation) {
  for (const int n : {1, 2, 30, 80}) {
    test::Random random(n);
    const Sparse m = test::RedundantMatrix(n, 1e-2, &random);
    const Planted planted = test::Plant(m, {.unbounded = 1}, &random);
    const LcpSolution s = test::Solve(OneStep(), planted.problem);
    EXPECT_EQ(s.report.stop, StopReason::kConverged);
    EXPECT_LE(s.report.factorisations, 1);
    const VectorXd truth = Eigen::MatrixXd(m).llt().solve(-planted.problem.q);
    const double residuals =
        test::MostResidual(planted.problem, s.x) + test::MostResidual(planted.problem, truth);
    EXPECT_LE(test::EnergyOfX(planted.problem, s.x - truth),
              test::MostApart(test::ScaledSpectrum(planted.problem), residuals));
  }
}

TEST(EveryMethod, SolvesInequalitiesOnly) {
  for (const PlantOptions options : {PlantOptions{.unbounded = 0, .two_sided = 0, .upper_only = 0},
                                     PlantOptions{.unbounded = 0, .two_sided = 0, .upper_only = 1},
                                     PlantOptions{.unbounded = 0, .two_sided = 1}}) {
    test::Random random(5);
    const Sparse m = test::DominantMatrix(50, 6, &random);
    const Planted planted = test::Plant(m, options, &random);
    for (const Settings& settings : AllMethods()) {
      SCOPED_TRACE(static_cast<int>(settings.method));
      ExpectPlanted(planted, test::Solve(settings, planted.problem));
    }
  }
}

// Every row or none at its bound.
TEST(EveryMethod, FindsAllRowsActiveOrNone) {
  for (const double active : {0.0, 1.0}) {
    test::Random random(6);
    const Sparse m = test::DominantMatrix(50, 6, &random);
    const Planted planted = test::Plant(m, {.unbounded = 0, .active = active}, &random);
    for (const Settings& settings : AllMethods()) {
      SCOPED_TRACE(static_cast<int>(settings.method));
      const LcpSolution s = test::Solve(settings, planted.problem);
      ExpectPlanted(planted, s);
    }
  }
}

// The scales of rows are 18 decades apart: pivots must not be judged by absolute size.
TEST(RobustMethods, SolveRowsOfAnyScale) {
  test::Random random(7);
  const Sparse m = test::RedundantMatrix(40, 1e-3, &random);
  VectorXd scale(40);
  for (int i = 0; i < 40; ++i) scale[i] = std::pow(10, random.Uniform(-4.5, 4.5));
  const Sparse scaled = scale.asDiagonal() * m * scale.asDiagonal();
  const Planted planted = test::Plant(scaled, {}, &random);
  for (const Settings& settings : RobustMethods()) {
    SCOPED_TRACE(static_cast<int>(settings.method));
    const LcpSolution s = test::Solve(settings, planted.problem);
    ASSERT_TRUE(s.report.ok());
    EXPECT_EQ(s.report.stop, StopReason::kConverged);
    EXPECT_TRUE(test::InsideBox(planted.problem, s.x));
    const double residuals =
        test::MostResidual(planted.problem, s.x) + test::MostResidual(planted.problem, planted.x);
    EXPECT_LE(test::EnergyOfX(planted.problem, s.x - planted.x),
              test::MostApart(test::ScaledSpectrum(planted.problem), residuals));
  }
}

/// No x satisfies it: x' M x is negative somewhere among the free rows.
BoxedLcp Indefinite() {
  const Eigen::Matrix3d m{{1, 2, 0}, {2, 1, 0}, {0, 0, 1}};
  return test::Boxed(m, VectorXd::Constant(3, -1), VectorXd::Constant(3, -10),
                     VectorXd::Constant(3, 10));
}

// Sweeps end at a corner of the box, where no reduced matrix is left that could be indefinite; the
// equations have no corner.
TEST(RobustMethods, SayThatAMatrixIsIndefinite) {
  BoxedLcp problem = Indefinite();
  problem.lo.setConstant(-kInfinity);
  problem.hi.setConstant(kInfinity);
  for (const Method method : {Method::kPgsSm, Method::kPgsSmLiteral, Method::kInteriorPoint}) {
    SCOPED_TRACE(static_cast<int>(method));
    const LcpSolution s = test::Solve(test::Until(method, 1e-9), problem);
    EXPECT_EQ(s.report.status, Status::kNotPositiveDefinite);
    EXPECT_TRUE(test::InsideBox(problem, s.x));
    EXPECT_LE(Measure(problem, s.x).energy, Measure(problem, VectorXd::Zero(3)).energy);
    EXPECT_EQ(s.report.residual_relative, Measure(problem, s.x).relative);
  }
}

// Sweeps of a matrix that is not definite grow without end where nothing bounds them.
TEST(EveryMethod, ReturnsFiniteNumbersWhereSweepsDiverge) {
  BoxedLcp problem = Indefinite();
  problem.lo.setConstant(-kInfinity);
  problem.hi.setConstant(kInfinity);
  for (Settings settings : AllMethods()) {
    settings.max_sweeps = 5000;
    SCOPED_TRACE(static_cast<int>(settings.method));
    EXPECT_TRUE(test::InsideBox(problem, test::Solve(settings, problem).x));
  }
}

TEST(EveryMethod, StaysInTheBoxOfAnIndefiniteMatrix) {
  const BoxedLcp problem = Indefinite();
  for (Settings settings : AllMethods()) {
    settings.max_sweeps = 1000;
    SCOPED_TRACE(static_cast<int>(settings.method));
    const LcpSolution s = test::Solve(settings, problem);
    EXPECT_TRUE(s.report.ok() || s.report.status == Status::kNotPositiveDefinite);
    EXPECT_TRUE(test::InsideBox(problem, s.x));
  }
}

}  // namespace
}  // namespace cairn::lcp
