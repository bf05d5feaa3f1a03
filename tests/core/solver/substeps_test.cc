// SPDX-License-Identifier: MIT
// Steps that are cut into parts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "cairn/detail/eigen.h"
#include "cairn/solver.h"
#include "tests/core/support/problems.h"

namespace cairn {
namespace {

using Eigen::Vector3d;
using test::Scene;
using test::Solution;

constexpr double kStep = 1.0 / 60;  // [s]
constexpr double kGravityStep = test::kGravityStep;

Settings InParts(int parts) {
  Settings settings;
  settings.substeps = parts;
  settings.tolerance = 0;
  settings.max_sweeps = 200;
  return settings;
}

/// A body that falls, and may touch the ground in one point below it.
struct Ball {
  Body body;
  Manifold manifold{.body_a = 0};
  ContactPoint point;
  ContactImpulse impulse;
  Velocity velocity, mean;

  Ball(double speed, double mass = 2) {
    body = test::PointMass(mass, Vector3d(0, 0, -mass * kGravityStep));
    body.velocity.linear = Vector3d(0, 0, speed);
    point.normal[2] = 1;
  }

  void Solve(int parts) {
    const ContactProblem problem{.bodies = {&body, 1},
                                 .manifolds = {&manifold, 1},
                                 .points = {&point, 1},
                                 .contact_law = {.bounce_speed = 0.5f},
                                 .time_step = kStep};
    Solver solver(InParts(parts));
    const Report report = solver.Solve(problem, {.points = {&impulse, 1}}, {&velocity, 1});
    ASSERT_TRUE(report.ok()) << Describe(report);
    if (parts > 1) {
      ASSERT_EQ(solver.mean_velocities().size(), size_t{1});
      mean = solver.mean_velocities()[0];
    }
  }
};

TEST(Substeps, FallsAsBodiesFallInSoManySteps) {
  for (const int parts : {2, 3, 8}) {
    Ball ball(1);
    ball.point.bias = -1e6f;  // far from the ground
    ball.Solve(parts);
    EXPECT_DOUBLE_EQ(ball.velocity.linear.z(), 1 - kGravityStep);
    // 1 - g h (1 + 2 + ... + n) / n^2
    EXPECT_NEAR(ball.mean.linear.z(), 1 - kGravityStep * (parts + 1) / (2.0 * parts), 1e-12);
    EXPECT_EQ(ball.impulse.normal, 0);
  }
}

TEST(Substeps, DoNotReadTheComplianceOfWhatIsHard) {
  Ball hard(-1), unread(-1);
  hard.point.bias = unread.point.bias = 0.3f;
  unread.point.compliance = 100;
  hard.Solve(4);
  unread.Solve(4);
  EXPECT_EQ(unread.velocity.linear, hard.velocity.linear);
  EXPECT_EQ(unread.mean.linear, hard.mean.linear);
}

TEST(Substeps, AddUpTheImpulsesOfTheirParts) {
  Ball ball(0);
  ball.Solve(5);
  EXPECT_NEAR(ball.impulse.normal, 2 * kGravityStep, 1e-6);
  EXPECT_NEAR(ball.velocity.linear.z(), 0, 1e-6);
  EXPECT_NEAR(ball.mean.linear.z(), 0, 1e-6);
}

// 3 m/s over 2 cm: it gets there in the second of four parts, and stays.
TEST(Substeps, CloseGapsWithoutGoingThrough) {
  Ball ball(-3);
  const double gap = 0.02;
  ball.point.bias = static_cast<float>(-gap / kStep);
  ball.Solve(4);
  EXPECT_NEAR(ball.mean.linear.z() * kStep, -gap, 1e-5);
  EXPECT_NEAR(ball.velocity.linear.z(), 0, 1e-3);
}

// A point is left with the speed that it came with, times its restitution, whenever in the step it
// is reached; at most the part before the ground is lost of the way.
TEST(Substeps, BounceOnceAsFastAsTheyCome) {
  for (const double gap : {0.0, 0.004, 0.012, 0.03, 0.045}) {
    for (const int parts : {2, 4, 7}) {
      Ball ball(-3);
      ball.point.bias = static_cast<float>(-gap / kStep);
      ball.point.restitution = 0.8f;
      ball.Solve(parts);
      SCOPED_TRACE(std::to_string(gap) + " " + std::to_string(parts));
      EXPECT_NEAR(ball.velocity.linear.z(), 0.8 * 3, 1.8 * kGravityStep);
      EXPECT_NEAR(ball.impulse.normal, 2 * 1.8 * 3, 2 * 1.8 * kGravityStep);
      EXPECT_GT(ball.mean.linear.z() * kStep, -gap - 1e-6);
    }
  }
}

TEST(Substeps, LeaveAPenetrationAsFastAsASingleStep) {
  Ball ball(0);
  ball.point.bias = 0.3f;
  ball.Solve(4);
  EXPECT_NEAR(ball.mean.linear.z(), 0.3, 1e-5);
  EXPECT_NEAR(ball.velocity.linear.z(), 0.3, 1e-5);
}

TEST(Substeps, SlideWithTheFrictionOfTheWholeStep) {
  Ball ball(0);
  ball.body.velocity.linear.x() = 1;
  ball.point.friction = 0.5f;
  ball.Solve(4);
  EXPECT_NEAR(ball.velocity.linear.x(), 1 - 0.5 * kGravityStep, 1e-6);
  // friction is of all parts, along the direction that is written
  const float* const t = ball.impulse.direction;
  EXPECT_NEAR(std::abs(t[0]), 1, 1e-6);
  EXPECT_NEAR(ball.impulse.tangential[0] * t[0], -2 * 0.5 * kGravityStep, 1e-6);
}

/// A rod of 1 m that a joint of three rows holds by its end, and turns about it.
struct Rod {
  Body body = test::Box(1, Vector3d(1, 0.1, 0.1));
  Joint joint{.body_a = 0, .rows = 3};
  JointRow rows[3];
  float impulses[3] = {};
  Velocity velocity, mean;
  Vector3d arm{-0.5, 0, 0};

  explicit Rod(const Vector3d& spin) {
    body.velocity.angular = spin;
    body.velocity.linear = -spin.cross(arm);
    for (int k = 0; k < 3; ++k) {
      rows[k].linear_a[k] = 1;
      const Vector3d turn = arm.cross(Vector3d::Unit(k));
      for (int i = 0; i < 3; ++i) rows[k].angular_a[i] = static_cast<float>(turn[i]);
    }
  }

  /// Where the end is after a step [m].
  double Gap(const Velocity& moved) const {
    const double angle = View(moved.angular).norm() * kStep;
    const Eigen::AngleAxisd turn(angle, View(moved.angular).normalized());
    return (View(moved.linear) * kStep + turn * arm - arm).norm();
  }

  Report Solve(Settings settings, double time_step = kStep) {
    const ContactProblem problem{
        .bodies = {&body, 1}, .joints = {&joint, 1}, .joint_rows = rows, .time_step = time_step};
    Solver solver(settings);
    Report report = solver.Solve(problem, {.joint_rows = impulses}, {&velocity, 1});
    if (!solver.mean_velocities().empty()) mean = solver.mean_velocities()[0];
    return report;
  }
};

TEST(Substeps, TurnTheArmsOfJoints) {
  Rod at_once(Vector3d(0, 0, 12));
  ASSERT_TRUE(at_once.Solve(InParts(1)).ok());
  const double gap = at_once.Gap(at_once.velocity);
  ASSERT_GT(gap, 0.005) << "not a hard case";
  Rod four(Vector3d(0, 0, 12)), sixteen(Vector3d(0, 0, 12)), frozen(Vector3d(0, 0, 12));
  ASSERT_TRUE(four.Solve(InParts(4)).ok());
  EXPECT_LT(four.Gap(four.mean), gap / 5);
  ASSERT_TRUE(sixteen.Solve(InParts(16)).ok());
  EXPECT_LT(sixteen.Gap(sixteen.mean), gap / 50);
  // nobody says how far bodies turn
  ASSERT_TRUE(frozen.Solve(InParts(4), 0).ok());
  EXPECT_GT(frozen.Gap(frozen.mean), gap / 2);
}

TEST(Substeps, TurnAboutAxesThatTurn) {
  // turns about axes that differ do not commute: the mean spin is that of all of them at once
  Rod at_once(Vector3d(9, 0, 8)), rod(Vector3d(9, 0, 8));
  rod.body.angular_impulse = at_once.body.angular_impulse = Vector3d(0, 0.02, 0);
  ASSERT_TRUE(at_once.Solve(InParts(1)).ok());
  ASSERT_TRUE(rod.Solve(InParts(16)).ok());
  EXPECT_LT(rod.Gap(rod.mean), at_once.Gap(at_once.velocity) / 20);
}

TEST(Substeps, GiveMotorsNoMoreThanTheyHaveInAStep) {
  Rod rod(Vector3d::Zero());
  rod.joint.bounded = 4;
  rod.rows[2].lo = -0.01f;
  rod.rows[2].hi = 0.01f;
  rod.rows[2].target = 5;
  ASSERT_TRUE(rod.Solve(InParts(3)).ok());
  EXPECT_FLOAT_EQ(rod.impulses[2], 0.01f);
}

TEST(Substeps, TakeThreeMotorsForNoPointThatIsHeld) {
  // the end of the rod moves at what they ask for, along the directions of the step
  Rod rod(Vector3d(0, 0, 12));
  rod.joint.bounded = 7;
  const Vector3d wanted(1, 2, 0);
  for (int k = 0; k < 3; ++k) {
    rod.rows[k].lo = -100;
    rod.rows[k].hi = 100;
    rod.rows[k].target = static_cast<float>(wanted[k]);
  }
  ASSERT_TRUE(rod.Solve(InParts(4)).ok());
  const Vector3d end = View(rod.velocity.linear) + View(rod.velocity.angular).cross(rod.arm);
  EXPECT_LT((end - wanted).norm(), 1e-3);
}

TEST(Substeps, LeaveImpulsesOfContactsAloneWhereThereAreNone) {
  Body body = test::PointMass(2, Vector3d::Zero());
  const ContactProblem problem{.bodies = {&body, 1}, .time_step = kStep};
  std::vector<ContactImpulse> points(1000, {.normal = 3});
  Velocity velocity;
  Solver solver(InParts(2));
  ASSERT_TRUE(solver.Solve(problem, {.points = points}, {&velocity, 1}).ok());
  EXPECT_EQ(points[999].normal, 3);
}

TEST(Substeps, StayWithinABudgetOfWork) {
  Settings settings = InParts(4);
  settings.k_sm = 0;
  const Scene scene = test::HangingChain(20, 5);
  const Report unlimited = test::Solve(settings, scene).report;
  ASSERT_GT(unlimited.work, 20'000);
  settings.budget = Budget::Work(unlimited.work / 4);
  const Report report = test::Solve(settings, scene).report;
  EXPECT_TRUE(report.ok());
  EXPECT_LE(report.work, unlimited.work / 2);
  EXPECT_GE(report.work, unlimited.work / 8);
  EXPECT_EQ(report.stop, StopReason::kWorkSpent);
}

TEST(Substeps, RefuseWhatIsOutOfRange) {
  for (const int parts : {0, 65}) {
    Rod rod(Vector3d::Zero());
    const Report report = rod.Solve(InParts(parts));
    EXPECT_EQ(report.status, Status::kBadSettings);
    EXPECT_STREQ(report.bad_setting.name, "substeps");
  }
  Rod rod(Vector3d::Zero());
  rod.velocity.linear.x() = 7;
  const Report report = rod.Solve(InParts(2), -1);
  EXPECT_EQ(report.status, Status::kNotFinite);
  EXPECT_EQ(rod.velocity.linear.x(), 7) << "written";
  EXPECT_THAT(Describe(report), testing::HasSubstr("problem.time_step"));
  const Replay replay;
  Settings settings = InParts(2);
  settings.tuning.replay = &replay;
  EXPECT_STREQ(rod.Solve(settings).bad_setting.name, "substeps");
}

// Row by row in double precision the parts are the same.
TEST(Substeps, DoTheSameInDoublePrecision) {
  Scene scene = test::HangingChain(5, 20);
  for (Body& body : scene.bodies) body.velocity.linear.x() = 0.3;
  Settings settings = InParts(4);
  settings.max_sweeps = 5000;
  const Solution fast = test::Solve(settings, scene);
  settings.path = Path::kReference;
  const Solution reference = test::Solve(settings, scene);
  ASSERT_EQ(fast.report.path, Path::kFast);
  ASSERT_EQ(reference.report.path, Path::kReference);
  EXPECT_LT(test::Distance(fast.v, reference.v), 1e-3);
  double most = 0;
  for (const double x : reference.x) most = std::max(most, std::abs(x));
  EXPECT_LT(test::Distance(fast.x, reference.x), 1e-3 * most);
}

// A chain that hangs still carries what it carries in one step.
TEST(Substeps, CarryTheSameLoad) {
  const Scene scene = test::HangingChain(5, 20);
  const Solution once = test::Solve(InParts(1), scene), parts = test::Solve(InParts(4), scene);
  EXPECT_LT(test::Distance(once.x, parts.x), 1e-3 * std::abs(once.x[2]));
  EXPECT_LT(test::Distance(once.v, parts.v), 1e-3);
}

TEST(Substeps, TellHowManyWouldDo) {
  Scene scene = test::HangingChain(3, 20);
  scene.bodies[1].strain = 17;
  scene.bodies[2].strain = 3;
  const Report report = test::Solve(Settings{}, scene).report;
  ASSERT_EQ(report.islands.size(), size_t{1});
  EXPECT_EQ(report.islands[0].strain, 17);
  EXPECT_EQ(report.islands[0].strained_body, 1);
  EXPECT_EQ(report.islands[0].enough_substeps, 3) << "17 / 9 is below 2, 17 / 4 is not";
  // strains are of the parts: 17 in halves is 68 of the whole
  EXPECT_EQ(test::Solve(InParts(2), scene).report.islands[0].enough_substeps, 6);
  scene.bodies[1].strain = scene.bodies[2].strain = 0;
  EXPECT_EQ(test::Solve(Settings{}, scene).report.islands[0].enough_substeps, 0);
  EXPECT_EQ(test::Solve(Settings{}, scene).report.islands[0].strained_body, -1);
}

}  // namespace
}  // namespace cairn
