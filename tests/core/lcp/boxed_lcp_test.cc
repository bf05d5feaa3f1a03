// SPDX-License-Identifier: MIT
// Measure() against its definitions, entry by entry in dense matrices.
#include "cairn/lcp/problem.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cairn/contact_problem.h"
#include "tests/core/support/lcp_problems.h"

namespace cairn::lcp {
namespace {

using Eigen::VectorXd;
using test::Planted;

double Clamped(double value, double lo, double hi) { return std::min(std::max(value, lo), hi); }

/// The definitions of LcpResidual.
LcpResidual ByDefinition(const BoxedLcp& problem, const VectorXd& x) {
  const Eigen::MatrixXd m(problem.M);
  const VectorXd w = m * x + problem.q;
  LcpResidual r;
  double natural = 0, q_energy = 0;
  for (int i = 0; i < x.size(); ++i) {
    const double d = m(i, i), lo = problem.lo[i], hi = problem.hi[i];
    const double e = d * std::abs(x[i] - Clamped(x[i] - w[i] / d, lo, hi));
    r.max = std::max(r.max, e);
    r.energy += e * e / d;
    q_energy += problem.q[i] * problem.q[i] / d;
    natural += std::pow(x[i] - Clamped(x[i] - w[i], lo, hi), 2);
    r.violation = std::max({r.violation, lo - x[i], x[i] - hi});
    const double bound = w[i] > 0 ? lo : hi;
    const double distance = std::isinf(bound) ? std::abs(w[i]) / d : std::abs(x[i] - bound);
    r.complementarity += std::abs(w[i]) * distance;
  }
  r.energy = std::sqrt(r.energy);
  r.relative = r.energy / std::sqrt(q_energy);
  r.natural = std::sqrt(natural) / problem.q.norm();
  r.objective = 0.5 * x.dot(m * x) + problem.q.dot(x);
  return r;
}

/// Sums of 40 terms in another order.
constexpr double kRounding = 1e-12;

void ExpectNear(const LcpResidual& actual, const LcpResidual& expected) {
  EXPECT_NEAR(actual.max, expected.max, kRounding * expected.max);
  EXPECT_NEAR(actual.energy, expected.energy, kRounding * expected.energy);
  EXPECT_NEAR(actual.relative, expected.relative, kRounding * expected.relative);
  EXPECT_NEAR(actual.natural, expected.natural, kRounding * expected.natural);
  EXPECT_NEAR(actual.complementarity, expected.complementarity,
              kRounding * expected.complementarity);
  EXPECT_NEAR(actual.objective, expected.objective, kRounding * (1 + std::abs(actual.objective)));
  EXPECT_EQ(actual.violation, expected.violation);
}

TEST(Measure, FollowsItsDefinitionsAtAnyPoint) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    test::Random random(seed);
    const Planted planted = test::Plant(test::DominantMatrix(40, 6, &random), {}, &random);
    VectorXd x = planted.x;
    for (double& entry : x) entry += random.Uniform(-2, 2);
    const LcpResidual expected = ByDefinition(planted.problem, x);
    EXPECT_GT(expected.violation, 0);
    ExpectNear(Measure(planted.problem, x), expected);
  }
}

// By hand: M = diag(2, 4), q = (-2, 4), 0 <= x <= (0.5, inf), at x = (0.5, 3): w = (-1, 16).
// Row 0 stands at the bound it is pushed against; row 1 would go to max(0, 3 - 4) = 0, so e = 12.
TEST(Measure, OfTwoRowsByHand) {
  const BoxedLcp problem = test::Boxed(Eigen::Vector2d(2, 4).asDiagonal(), Eigen::Vector2d(-2, 4),
                                       Eigen::Vector2d::Zero(), Eigen::Vector2d(0.5, kInfinity));
  const LcpResidual r = Measure(problem, Eigen::Vector2d(0.5, 3));
  EXPECT_EQ(r.max, 12);
  EXPECT_EQ(r.energy, 6);                          // sqrt(12^2 / 4)
  EXPECT_DOUBLE_EQ(r.relative, 6 / std::sqrt(6));  // q' D^-1 q = 2 + 4
  EXPECT_DOUBLE_EQ(r.natural, 3 / std::sqrt(20));  // x1 - max(0, 3 - 16) = 3
  EXPECT_EQ(r.violation, 0);
  EXPECT_EQ(r.complementarity, 48);  // 1 * 0 + 16 * 3
  EXPECT_EQ(r.objective, 0.25 + 18 - 1 + 12);
}

// Dyadic numbers: q = w - M x is exact, and so is everything after it.
TEST(Measure, IsZeroAtASolutionToTheBit) {
  const Eigen::Matrix4d m{{4, -1, 0, 0}, {-1, 4, -1, 0}, {0, -1, 4, -1}, {0, 0, -1, 4}};
  const Eigen::Vector4d x(0, 0.5, 2, -3), w(1, 0, -0.25, 0);
  const BoxedLcp problem = test::Boxed(m, w - m * x, Eigen::Vector4d(0, -1, 0, -kInfinity),
                                       Eigen::Vector4d(kInfinity, 1, 2, kInfinity));
  const LcpResidual r = Measure(problem, x);
  EXPECT_EQ(r.max, 0);
  EXPECT_EQ(r.energy, 0);
  EXPECT_EQ(r.relative, 0);
  EXPECT_EQ(r.natural, 0);
  EXPECT_EQ(r.violation, 0);
  EXPECT_EQ(r.complementarity, 0);
}

// x - clamp(x - w / d) is 0 there in floating point, and was taken for a solution.
TEST(Measure, SeesASmallErrorBesideALargeX) {
  const LcpResidual residual = Measure(test::WithoutSolution(), VectorXd::Constant(2, 2e17));
  EXPECT_EQ(residual.max, 1);
  EXPECT_EQ(residual.natural, 1);
}

// Nothing to be relative to: the relative measures are the absolute ones.
TEST(Measure, IsAbsoluteWithoutQ) {
  const BoxedLcp problem =
      test::Boxed(Eigen::Vector2d(2, 8).asDiagonal(), Eigen::Vector2d::Zero(),
                  Eigen::Vector2d::Constant(-kInfinity), Eigen::Vector2d::Constant(kInfinity));
  const LcpResidual r = Measure(problem, Eigen::Vector2d(1, 1));
  EXPECT_DOUBLE_EQ(r.energy, std::sqrt(10));  // w = (2, 8): 4 / 2 + 64 / 8
  EXPECT_EQ(r.relative, r.energy);
  EXPECT_DOUBLE_EQ(r.natural, std::sqrt(68));
  EXPECT_EQ(r.max, 8);
  EXPECT_DOUBLE_EQ(r.complementarity, 10);  // no bounds: w^2 / d
}

// Row i of the scaled problem is s_i times that of the other, x_i is 1 / s_i.
TEST(Measure, OfEnergiesDoesNotSeeTheScaleOfRows) {
  test::Random random(3);
  const Planted planted = test::Plant(test::DominantMatrix(30, 6, &random), {}, &random);
  VectorXd x = planted.x, s(30);
  for (double& entry : x) entry += random.Uniform(-1, 1);
  for (double& entry : s) entry = random.Uniform(0.01, 100);
  BoxedLcp scaled = planted.problem;
  scaled.M = s.asDiagonal() * planted.problem.M * s.asDiagonal();
  scaled.q = s.cwiseProduct(planted.problem.q);
  scaled.lo = planted.problem.lo.cwiseQuotient(s);
  scaled.hi = planted.problem.hi.cwiseQuotient(s);

  const LcpResidual before = Measure(planted.problem, x);
  const LcpResidual after = Measure(scaled, x.cwiseQuotient(s));
  EXPECT_NEAR(after.energy, before.energy, kRounding * before.energy);
  EXPECT_NEAR(after.relative, before.relative, kRounding);
  EXPECT_NEAR(after.complementarity, before.complementarity, kRounding * before.complementarity);
  EXPECT_NEAR(after.objective, before.objective, kRounding * (1 + std::abs(before.objective)));
}

TEST(Measure, OfNothingIsNothing) {
  const LcpResidual r = Measure(BoxedLcp{}, VectorXd());
  EXPECT_EQ(r.max, 0);
  EXPECT_EQ(r.relative, 0);
  EXPECT_EQ(r.natural, 0);
  EXPECT_EQ(r.objective, 0);
}

}  // namespace
}  // namespace cairn::lcp
