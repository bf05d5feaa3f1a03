// SPDX-License-Identifier: MIT
// What the settings and the finer fields of a row promise, sweep by sweep, by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/support/problems.h"

namespace cairn {
namespace {

using Eigen::Vector3d;
using test::PlainSweeps;
using test::PointMass;
using test::PushRow;
using test::Scene;
using test::Solution;

/// A unit mass falling with 1 m/s onto the ground: w = -1 + x, one sweep solves it.
Scene FallingMass() {
  Scene scene;
  scene.bodies = {PointMass(1)};
  scene.bodies[0].velocity.linear = {0, 0, -1};
  scene.rows = {PushRow(0, kWorld, {0, 0, 1})};
  return scene;
}

// Friction may do mu x_n = 0.5 here, but the cap of a rolling row is tighter on one side.
TEST(FrictionRow, IsCutDownToItsOwnBounds) {
  for (const auto& [speed, lo, hi, expected] : {std::tuple(-9.0, -0.1, 0.2, 0.2),
                                                {9.0, -0.1, 0.2, -0.1},
                                                {-9.0, -5.0, 5.0, 0.5},
                                                {9.0, -5.0, 5.0, -0.5},
                                                {-0.15, -0.1, 0.2, 0.15},
                                                {9.0, 0.0, 0.0, 0.0}}) {
    Scene scene = FallingMass();
    scene.bodies[0].inv_inertia = Eigen::Matrix3d::Identity();
    scene.bodies[0].velocity.angular = {speed, 0, 0};
    Row rolling = test::AngularRow(0, kWorld, {1, 0, 0});
    rolling.parent = 0;
    rolling.friction = 0.5;
    rolling.lo = lo;
    rolling.hi = hi;
    scene.rows.push_back(rolling);
    for (const Settings& settings : {PlainSweeps(3), test::AlwaysSteps(20)}) {
      const Solution s = test::Solve(settings, scene);
      EXPECT_NEAR(s.x[1], expected, 1e-15) << speed;
      EXPECT_NEAR(s.v[0].angular.x(), speed + expected, 1e-15);
    }
  }
}

/// A unit mass leaving the ground with 1 m/s, that pushed with 1 N s and rubbed with 0.5 N s
/// before.
Scene LeavingMass() {
  Scene scene = FallingMass();
  scene.bodies[0].velocity.linear = {0, 0, 1};
  Row rubbing = test::LinearRow(0, kWorld, {1, 0, 0});
  rubbing.parent = 0;
  rubbing.friction = 1;
  scene.rows.push_back(rubbing);
  return scene;
}

// The first sweep takes the normal impulse to 0: what friction does then is the setting.
TEST(LiftedFriction, IsReleasedOrHeld) {
  Settings settings = PlainSweeps(10);
  const Solution released = test::Solve(settings, LeavingMass(), {1, 0.5});
  EXPECT_EQ(released.x, (std::vector<double>{0, 0}));
  EXPECT_EQ(released.v[0].linear, Vector3d(0, 0, 1));

  settings.tuning.lifted_friction = detail::LiftedFriction::kHold;
  const Solution held = test::Solve(settings, LeavingMass(), {1, 0.5});
  EXPECT_EQ(held.x, (std::vector<double>{0, 0.5}));
  EXPECT_EQ(held.v[0].linear, Vector3d(0.5, 0, 1));
}

// Held or not, friction of a contact that starts without impulse starts without impulse.
TEST(LiftedFriction, IsNotHeldFromAWarmStartOutsideItsBounds) {
  Settings settings = PlainSweeps(10);
  settings.tuning.lifted_friction = detail::LiftedFriction::kHold;
  EXPECT_EQ(test::Solve(settings, LeavingMass(), {0, 0.5}).x, (std::vector<double>{0, 0}));
}

// With relaxation 1/2 the distance to x = 1 halves in every sweep that the row takes part in.
TEST(Row, TakesPartInAsManySweepsAsItSays) {
  for (const auto& [sweeps, expected] : {std::pair(0, 0.0), {1, 0.5}, {2, 0.75}, {4, 0.9375}}) {
    Scene scene = FallingMass();
    scene.rows[0].relaxation = 0.5;
    scene.rows[0].host.max_sweeps = sweeps;
    EXPECT_EQ(test::Solve(PlainSweeps(50), scene).x[0], expected) << sweeps;
  }
}

TEST(Row, LeavesOthersSweepingWhenItsSweepsAreOver) {
  Scene scene;
  scene.bodies = {PointMass(1), PointMass(1)};
  for (int i : {0, 1}) {
    scene.rows.push_back(test::LinearRow(i, kWorld, {1, 0, 0}));
    scene.rows[i].target = 1;
    scene.rows[i].relaxation = 0.5;
  }
  scene.rows.push_back(test::LinearRow(0, 1, {0, 1, 0}));  // one island
  scene.rows[0].host.max_sweeps = 1;
  EXPECT_EQ(test::Solve(PlainSweeps(3), scene).x, (std::vector<double>{0.5, 0.875, 0}));
}

// 1.5 of every correction: x = 1.5, then 1.5 - 1.5 * 0.5 = 0.75, then 0.75 + 1.5 * 0.25 = 1.125.
TEST(Psor, OverrelaxesByOmegaAndOnlyWhenAsked) {
  Settings settings = PlainSweeps(0);
  settings.tuning.omega = 1.5;
  for (const auto& [sweeps, expected] : {std::pair(1, 1.5), {2, 0.75}, {3, 1.125}}) {
    settings.max_sweeps = sweeps;
    settings.method = Method::kPsor;
    EXPECT_EQ(test::Solve(settings, FallingMass()).x[0], expected);
    settings.method = Method::kPgs;
    EXPECT_EQ(test::Solve(settings, FallingMass()).x[0], 1);
    settings.method = Method::kPgsSm;
    settings.k_sm = 2;
    EXPECT_EQ(test::Solve(settings, FallingMass()).x[0], 1);
    settings.k_sm = 0;
  }
}

// The factors of setting and row multiply: 0.5 * 1.5 = 0.75 of the way.
TEST(Psor, OverrelaxesOnTopOfTheRowsOwnRelaxation) {
  Scene scene = FallingMass();
  scene.rows[0].relaxation = 0.5;
  Settings settings = PlainSweeps(1);
  settings.method = Method::kPsor;
  settings.tuning.omega = 1.5;
  EXPECT_EQ(test::Solve(settings, scene).x[0], 0.75);
}

// With relaxation 1/2 the sweeps move the row by 1/2, 1/4, 1/8 m/s: the third is the first that
// moves it by no more than 0.2, the second the first by no more than 1/4.
TEST(MinProgress, EndsTheIterationAfterTheFirstSweepThatMovesNothingFurther) {
  Scene scene = FallingMass();
  scene.rows[0].relaxation = 0.5;
  Settings settings = PlainSweeps(50);
  for (const auto& [progress, sweeps] : {std::pair(0.2, 3), {0.25, 2}, {10.0, 1}}) {
    settings.tuning.min_progress = progress;
    const Solution s = test::Solve(settings, scene);
    EXPECT_EQ(s.report.sweeps, sweeps);
    EXPECT_EQ(s.report.stop, StopReason::kStationary);
    EXPECT_EQ(s.x[0], 1 - std::pow(0.5, sweeps));
  }
}

// In m/s, not in N s: a mass of 1/1000 kg moves by 1/2 m/s for 1/2000 N s.
TEST(MinProgress, IsAVelocity) {
  Scene scene = FallingMass();
  scene.bodies[0].inv_mass = 1000;
  scene.rows[0].relaxation = 0.5;
  Settings settings = PlainSweeps(50);
  settings.tuning.min_progress = 0.2;
  EXPECT_EQ(test::Solve(settings, scene).report.sweeps, 3);
}

// The residual halves with every sweep, from 1: after sweeps 2 and 4 it is 1/4 and 1/16. It is
// looked at after k_gs sweeps only.
TEST(Tolerance, EndsTheIterationWhenTheResidualIsNoLarger) {
  Scene scene = FallingMass();
  scene.rows[0].relaxation = 0.5;
  Settings settings = PlainSweeps(50);
  settings.k_gs = 2;
  for (const auto& [tolerance, sweeps] : {std::pair(0.25, 2), {0.24, 4}, {0.0625, 4}}) {
    settings.tolerance = tolerance;
    const Solution s = test::Solve(settings, scene);
    EXPECT_EQ(s.report.sweeps, sweeps);
    EXPECT_EQ(s.report.stop, StopReason::kConverged);
    EXPECT_EQ(s.report.residual_max, std::pow(0.5, sweeps));
  }
}

TEST(StopReason, SaysWhyTheIterationEnded) {
  Scene scene = FallingMass();
  scene.rows[0].relaxation = 0.5;
  Settings settings = PlainSweeps(3);
  EXPECT_EQ(test::Solve(settings, scene).report.stop, StopReason::kSweepLimit);
  settings.max_sweeps = 0;
  EXPECT_EQ(test::Solve(settings, scene).report.stop, StopReason::kSweepLimit);
  settings.max_sweeps = 2000;
  EXPECT_EQ(test::Solve(settings, scene).report.stop, StopReason::kStationary);
  settings.budget = Budget::Work(4);
  EXPECT_EQ(test::Solve(settings, scene).report.stop, StopReason::kWorkSpent);
  settings.budget = Budget::Time(std::chrono::nanoseconds(0));
  EXPECT_EQ(test::Solve(settings, scene).report.stop, StopReason::kTimeSpent);
  settings.budget = Budget::Unlimited();
  settings.tolerance = 0.5;
  EXPECT_EQ(test::Solve(settings, scene).report.stop, StopReason::kConverged);
  scene.rows[0].lo = 1e300;
  scene.rows[0].hi = -1;
  EXPECT_EQ(test::Solve(settings, scene).report.stop, StopReason::kNotStarted);
}

// Two islands, one of which is done at once: the whole says what held back the other.
TEST(StopReason, OfTheWholeIsThatOfTheIslandThatWasHeldBackMost) {
  Scene scene = FallingMass();
  scene.bodies.push_back(scene.bodies[0]);
  scene.rows.push_back(PushRow(1, kWorld, {0, 0, 1}));
  scene.rows[1].relaxation = 0.5;
  Settings settings = PlainSweeps(10);
  const Report report = test::Solve(settings, scene).report;
  EXPECT_EQ(report.stop, StopReason::kSweepLimit);
  ASSERT_EQ(report.islands.size(), 2u);
  EXPECT_EQ(report.islands[0].stop, StopReason::kStationary);
  EXPECT_EQ(report.islands[0].sweeps, 2);
  EXPECT_EQ(report.islands[1].stop, StopReason::kSweepLimit);
  EXPECT_EQ(report.islands[1].sweeps, 10);
  EXPECT_EQ(report.sweeps, 10);
}

}  // namespace
}  // namespace cairn
