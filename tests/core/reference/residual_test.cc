// SPDX-License-Identifier: MIT
// Measure(): the natural map, by hand and against the formula on dense matrices.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/support/dense.h"
#include "tests/core/support/problems.h"

namespace cairn {
namespace {

using test::Scene;

Scene MixedScene(std::uint64_t seed) {
  Scene scene = test::RandomPile({.bodies = 10, .contacts = 15, .pins = 3}, seed);
  test::Random random(seed);
  for (int i = 0; i < 5; ++i) {  // motors and limits that only turn
    const int a = random.Index(5), b = 5 + random.Index(5);
    Row row = test::AngularRow(a, b, random.Direction());
    row.target = random.Uniform(-1, 1);
    row.lo = -random.Uniform(0, 1);
    row.hi = random.Uniform(0, 1);
    scene.rows.push_back(row);
  }
  return scene;
}

/// Feasible impulses and others.
std::vector<std::vector<double>> Impulses(const Scene& scene, std::uint64_t seed) {
  test::Random random(seed);
  std::vector<double> any(scene.rows.size()), near = test::Solve(test::PlainSweeps(30), scene).x;
  for (double& x : any) x = random.Uniform(-1, 1);
  return {any, near, std::vector<double>(scene.rows.size(), 0.0)};
}

TEST(Measure, IsTheNaturalMapOfTheDenseProblem) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Scene scene = MixedScene(seed);
    const test::Dense dense = test::MakeDense(scene);
    for (const std::vector<double>& x : Impulses(scene, seed)) {
      const Report report = Measure(scene.problem(), x);
      const Residual expected = test::DenseResidual(scene, dense, test::ToVector(x));
      ASSERT_TRUE(report.ok());
      EXPECT_GT(expected.max_angular, 0);
      // Rounding of sums of 60 terms of size 10; the rows themselves are of size 0.01 to 10.
      EXPECT_NEAR(report.residual_max, expected.max, 1e-12);
      EXPECT_NEAR(report.residual_angular, expected.max_angular, 1e-12);
      EXPECT_NEAR(report.residual_energy, expected.energy, 1e-12);
    }
  }
}

TEST(Measure, SaysWhatTheSolverSaysOfItsResult) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Scene scene = MixedScene(seed);
    const test::Solution s = test::Solve(test::AlwaysSteps(30), scene);
    const Report report = Measure(scene.problem(), s.x);
    // The solver measures velocities that carry the rounding of 30 sweeps.
    EXPECT_NEAR(report.residual_max, s.report.residual_max, 1e-12);
    EXPECT_NEAR(report.residual_angular, s.report.residual_angular, 1e-12);
    EXPECT_NEAR(report.residual_energy, s.report.residual_energy, 1e-12);
    ASSERT_EQ(report.islands.size(), s.report.islands.size());
    for (size_t i = 0; i < report.islands.size(); ++i) {
      EXPECT_EQ(report.islands[i].first_body, s.report.islands[i].first_body);
      EXPECT_EQ(report.islands[i].bodies, s.report.islands[i].bodies);
      EXPECT_EQ(report.islands[i].rows, s.report.islands[i].rows);
      EXPECT_NEAR(report.islands[i].residual.energy, s.report.islands[i].residual.energy, 1e-12);
    }
  }
}

// A mass of 2 kg at 3 m/s towards the ground, d = 1/2. Without an impulse it lacks x = 6: the
// error is d 6 = 3 m/s, the energy 3^2 / d = 18 J. With x = 8 it separates with 1 m/s although the
// ground still pushes. Leaving with x = 0 is right, whatever the speed.
TEST(Measure, IsZeroExactlyWhereTheLawHolds) {
  Scene scene;
  scene.bodies = {test::PointMass(2)};
  scene.bodies[0].velocity.linear = {0, 0, -3};
  scene.rows = {test::PushRow(0, kWorld, {0, 0, 1})};
  const auto measure = [&](double x) { return Measure(scene.problem(), std::vector{x}); };
  EXPECT_DOUBLE_EQ(measure(0).residual_max, 3);
  EXPECT_DOUBLE_EQ(measure(0).residual_energy, std::sqrt(18));
  EXPECT_NEAR(measure(8).residual_max, 1, 1e-14);
  EXPECT_LT(measure(6).residual_max, 1e-14);      // 1 / sqrt(2) twice is not 1 / 2
  EXPECT_DOUBLE_EQ(measure(-2).residual_max, 4);  // pulls, and is 8 N s short

  scene.bodies[0].velocity.linear = {0, 0, 100};
  EXPECT_EQ(measure(0).residual_max, 0);
  EXPECT_DOUBLE_EQ(measure(1e-3).residual_max, 5e-4);  // no further than back to the bound
}

// The bound of friction is that of the present normal impulse, even where that is wrong itself.
TEST(Measure, TakesTheBoundsOfFrictionFromTheImpulseOfItsParent) {
  Scene scene;
  scene.bodies = {test::PointMass(1)};
  scene.bodies[0].velocity.linear = {10, 0, 0};
  scene.rows = {test::PushRow(0, kWorld, {0, 0, 1}), test::LinearRow(0, kWorld, {1, 0, 0})};
  scene.rows[0].target = 1;  // x = 1 there
  scene.rows[1].parent = 0;
  scene.rows[1].friction = 0.5;
  EXPECT_DOUBLE_EQ(Measure(scene.problem(), std::vector{1.0, -0.5}).residual_max, 0);
  EXPECT_DOUBLE_EQ(Measure(scene.problem(), std::vector{1.0, -0.25}).residual_max, 0.25);
  EXPECT_DOUBLE_EQ(Measure(scene.problem(), std::vector{1.0, -0.75}).residual_max, 0.25);
  EXPECT_DOUBLE_EQ(Measure(scene.problem(), std::vector{-1.0, -0.25}).residual_max, 2);
}

TEST(Measure, AddsIslandsUpAsEnergiesAndTakesTheLargestVelocity) {
  Scene scene;
  scene.bodies = {test::PointMass(1), test::PointMass(1)};
  scene.rows = {test::LinearRow(0, kWorld, {1, 0, 0}), test::LinearRow(1, kWorld, {1, 0, 0})};
  scene.rows[0].target = 3;
  scene.rows[1].target = 4;
  const Report report = Measure(scene.problem(), std::vector{0.0, 0.0});
  EXPECT_DOUBLE_EQ(report.residual_max, 4);
  EXPECT_DOUBLE_EQ(report.residual_energy, 5);
  ASSERT_EQ(report.islands.size(), 2u);
  EXPECT_DOUBLE_EQ(report.islands[0].residual.energy, 3);
}

}  // namespace
}  // namespace cairn
