// SPDX-License-Identifier: MIT
// Bodies that may not move along, or turn about, some axes, as those of a game in a plane.
#include "problem/locked_axes.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "cairn/detail/eigen.h"
#include "cairn/solver.h"

namespace cairn {
namespace {

using Eigen::Vector3d;

/// A ball of 1 kg and 0.5 m at the origin, which may not move along y.
Body FlatBall() {
  return {.inv_mass = 1, .inv_inertia = Matrix3::Diagonal(10, 10, 10), .linear_factor = {1, 0, 1}};
}

struct Solved {
  std::vector<Velocity> velocities;
  double normal;
};

/// Pushes body 0 out of what is below it, which is body 1 or the world.
Solved Push(const std::vector<Body>& bodies, const Vector3d& normal, Path path, int sweeps = 100) {
  const Manifold manifold{.body_a = 0, .body_b = bodies.size() > 1 ? 1 : kWorld, .tangents = 2};
  ContactPoint point{.friction = 0.5};
  const Vector3d arm = -0.5 * normal;
  for (int k = 0; k < 3; ++k) {
    point.normal[k] = static_cast<float>(normal[k]);
    point.arm_a[k] = static_cast<float>(arm[k]);
  }
  point.bias = 0.5f;
  ContactImpulse impulse;
  Solved solved{.velocities = std::vector<Velocity>(bodies.size()), .normal = 0};
  Solver solver({.path = path, .max_sweeps = sweeps});
  const Report report =
      solver.Solve({.bodies = bodies, .manifolds = {&manifold, 1}, .points = {&point, 1}},
                   {.points = {&impulse, 1}}, solved.velocities);
  EXPECT_TRUE(report.ok()) << Describe(report);
  solved.normal = impulse.normal;
  return solved;
}

TEST(LockedAxes, AreZerosOfABody) {
  EXPECT_TRUE(HasLockedAxes(FlatBall()));
  EXPECT_TRUE(HasLockedAxes({.inv_mass = 1, .inv_inertia = Matrix3::Diagonal(0, 1, 0)}));
  EXPECT_FALSE(HasLockedAxes({.inv_mass = 1, .inv_inertia = Matrix3::Diagonal(1, 2, 3)}));
  EXPECT_FALSE(HasLockedAxes({.inv_mass = 1}));  // turns about none
  EXPECT_FALSE(HasLockedAxes(Body{}));
}

// Along a normal that leans by rounding it would have to go a million times as far.
TEST(LockedAxes, AreNotPushedAlongByADetour) {
  for (const Path path : {Path::kFast, Path::kReference}) {
    for (const double lean : {0.0, 1e-12, 1e-7, 1e-4, 1e-2}) {
      Body ball = FlatBall();
      ball.velocity = {.linear = {4, 0, 0}};
      const Solved solved = Push({ball}, Vector3d(lean, 1, 0).normalized(), path);
      EXPECT_EQ(solved.velocities[0].linear, Vector3(4, 0, 0)) << lean;
      EXPECT_EQ(solved.velocities[0].angular, Vector3()) << lean;
    }
    // what leans by a fifth does push
    const Solved solved = Push({FlatBall()}, Vector3d(0.2, 1, 0).normalized(), path);
    EXPECT_GT(solved.velocities[0].linear.x(), 1);
    EXPECT_LT(solved.velocities[0].linear.x(), 5);
  }
}

// Solved exactly, the ball would take fifteen times the target of 0.5 m/s where the normal leans by
// 0.07.
TEST(LockedAxes, AreNotPushedFarByFewSweeps) {
  for (const Path path : {Path::kFast, Path::kReference}) {
    for (const double lean : {0.04, 0.07, 0.1, 0.2}) {
      const Solved few = Push({FlatBall()}, Vector3d(lean, 1, 0).normalized(), path, 4);
      EXPECT_LE(View(few.velocities[0].linear).norm(), 10 * lean) << lean;
      EXPECT_GT(few.normal, 0);
    }
  }
}

TEST(LockedAxes, HoldUpWhatIsFree) {
  for (const Path path : {Path::kFast, Path::kReference}) {
    // the ball is above: it stays, and the crate of a ton gives way
    const Body crate{.inv_mass = 1e-3, .inv_inertia = Matrix3::Diagonal(1e-3, 1e-3, 1e-3)};
    const Solved solved = Push({FlatBall(), crate}, Vector3d(1e-7, 1, 0), path);
    EXPECT_NEAR(solved.velocities[1].linear.y(), -0.5, 1e-3);
    EXPECT_NEAR(solved.normal, 500, 1);
    EXPECT_LE(View(solved.velocities[0].linear).norm(), 1e-3);
  }
}

TEST(LockedAxes, AreNotTurnedAboutByRounding) {
  for (const Path path : {Path::kFast, Path::kReference}) {
    const Body spinner{.inv_mass = 1, .inv_inertia = Matrix3::Diagonal(0, 0, 5)};
    const Joint joint{.body_a = 0, .rows = 2, .angular = 3};
    // about x, and about z, both turned by rounding
    std::array<JointRow, 2> rows;
    rows[0].angular_a[0] = 1;
    rows[0].angular_a[2] = 1e-7f;
    rows[0].target = 0.1f;
    rows[1].angular_a[2] = 1;
    rows[1].angular_a[0] = 1e-7f;
    rows[1].target = 0.2f;
    std::array<float, 2> impulses{};
    Velocity velocity;
    Solver solver({.path = path});
    const Report report =
        solver.Solve({.bodies = {&spinner, 1}, .joints = {&joint, 1}, .joint_rows = rows},
                     {.joint_rows = impulses}, {&velocity, 1});
    ASSERT_TRUE(report.ok()) << Describe(report);
    EXPECT_EQ(impulses[0], 0);
    EXPECT_NEAR(velocity.angular.z(), 0.2, 1e-6);
  }
}

// Rotation alone may answer, where the arm is long enough.
TEST(LockedAxes, TurnWhatMayNotMove) {
  for (const Path path : {Path::kFast, Path::kReference}) {
    Body pinned = FlatBall();
    pinned.linear_factor = {0, 0, 0};
    const Manifold manifold{.body_a = 0};
    ContactImpulse impulse;
    Velocity velocity;
    for (const float arm : {0.4f, 1e-3f}) {
      ContactPoint point{.bias = 0.5f};
      point.normal[1] = 1;
      point.arm_a[0] = arm;
      impulse = {};
      Solver solver({.path = path});
      const Report report =
          solver.Solve({.bodies = {&pinned, 1}, .manifolds = {&manifold, 1}, .points = {&point, 1}},
                       {.points = {&impulse, 1}}, {&velocity, 1});
      ASSERT_TRUE(report.ok()) << Describe(report);
      EXPECT_NEAR(velocity.angular.z(), arm > 0.1f ? 0.5 / 0.4 : 0, 1e-3);
    }
  }
}

}  // namespace
}  // namespace cairn
