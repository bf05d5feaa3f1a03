// SPDX-License-Identifier: MIT
// Joints from anchors and axes: one law for each kind, signs, targets and limits.
#include "cairn/joints.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "engine/angle.h"
#include "tests/core/engine/small_world.h"

namespace cairn {
namespace {

using test::SmallWorld;
using test::Thing;
using test::Vector3d;

/// Adds a joint between a thing and the world, at a point of the thing, with the axes of the world.
void Hold(const JointKind& kind, const Vector3d& anchor, SmallWorld* world) {
  const JointSide side = world->things[0].Side(0, anchor);
  world->joints.Add(kind, side, {.anchor = Vector3d::Zero()}, 1);
}

/// A body whose point @p anchor is at the origin, after so many steps.
SmallWorld Drive(const JointKind& kind, const Vector3d& anchor, int steps, double gravity = 9.81) {
  SmallWorld world;
  world.gravity = gravity;
  world.things.push_back({.mass = 2, .position = -anchor});
  for (int i = 0; i < steps; ++i) {
    world.Step([&](SmallWorld* w) { Hold(kind, anchor, w); });
  }
  return world;
}

double GapOf(const Thing& thing, const Vector3d& anchor) {
  return (thing.position + thing.turn * anchor).norm();
}

/// Turn about x, right-handed, of a thing that turns about nothing else.
double AngleAboutX(const Thing& thing) { return 2 * std::atan2(thing.turn.x(), thing.turn.w()); }

TEST(Joints, BallKeepsItsPointAndLetsItTurn) {
  const Vector3d anchor(1, 0, 0);
  const SmallWorld world = Drive(BallJoint(), anchor, 40);
  EXPECT_LE(GapOf(world.things[0], anchor), 0.02);
  EXPECT_GT(world.things[0].velocity.angular.norm(), 1);
}

TEST(Joints, MakeAProblemThatKnowsHowLongItsStepIs) {
  const StepInput step{.time_step = 0.01};
  EXPECT_EQ(ProblemOf(step, Contacts(), Joints()).time_step, 0.01);
}

TEST(Joints, TakeBackTheirShareOfAGapInAStep) {
  SmallWorld world;
  world.gravity = 0;
  world.things.push_back({.position = {0.1, 0, 0}});
  world.Step([](SmallWorld* w) { Hold(BallJoint(), Vector3d::Zero(), w); });
  EXPECT_NEAR(world.things[0].position.x(), 0.08, 1e-6);
}

TEST(Joints, HingeTurnsAboutXOnly) {
  // an arm along z under gravity turns about x; one along x cannot
  const SmallWorld swings = Drive(HingeJoint(), {0, 0, 1}, 20);
  EXPECT_GT(swings.things[0].velocity.angular.x() * -1, 0.5);
  const SmallWorld held = Drive(HingeJoint(), {1, 0, 0}, 60);
  EXPECT_LE(held.things[0].velocity.angular.norm(), 1e-3);
  EXPECT_LE(held.things[0].position.y() * -1, 2e-3);
}

TEST(Joints, MotorTurnsByTheRightHandWithItsTorque) {
  // I w = torque t, here about an axis through the centre; I = 0.4
  const SmallWorld weak = Drive(HingeJoint({.speed = 100, .motor_most = 0.8}), {0, 0, 0}, 30);
  EXPECT_NEAR(weak.things[0].velocity.angular.x(), 0.8 / 0.4 * 0.5, 1e-4);
  const SmallWorld strong = Drive(HingeJoint({.speed = -3, .motor_most = 1e4}), {0, 0, 0}, 30);
  EXPECT_NEAR(strong.things[0].velocity.angular.x(), -3, 1e-4);
  EXPECT_NEAR(AngleAboutX(strong.things[0]), -1.5, 1e-3);
}

TEST(Joints, LimitsStopBothWays) {
  for (const double speed : {2.0, -2.0}) {
    const JointAxis about{.lo = -0.5, .hi = 0.75, .speed = speed, .motor_most = 10};
    const SmallWorld world = Drive(HingeJoint(about), {0, 0, 0}, 60);
    EXPECT_NEAR(AngleAboutX(world.things[0]), speed > 0 ? 0.75 : -0.5, 1e-4);
    EXPECT_LE(world.things[0].velocity.angular.norm(), 1e-4);
  }
}

TEST(Joints, LimitsTakeBackWhatIsBeyondThem) {
  SmallWorld world;
  world.gravity = 0;
  world.things.push_back({.position = {1, 0, 0}});
  world.Step([](SmallWorld* w) { Hold(SliderJoint({.hi = 0.5}), Vector3d::Zero(), w); });
  EXPECT_NEAR(world.things[0].position.x(), 0.9, 1e-6);  // a fifth of 0.5 m
}

TEST(Joints, SliderMovesAlongXOnly) {
  // F t = m v, against nothing: gravity is across
  const SmallWorld world = Drive(SliderJoint({.speed = 100, .motor_most = 4}), {0, 0.3, 0}, 30);
  const Thing& thing = world.things[0];
  EXPECT_NEAR(thing.velocity.linear.x(), 4 / 2.0 * 0.5, 1e-3);
  EXPECT_NEAR(thing.position.y(), -0.3, 1e-4);
  EXPECT_LE(thing.velocity.angular.norm(), 1e-3);
}

TEST(Joints, FixedHoldsALever) {
  const SmallWorld world = Drive(FixedJoint(), {1, 0, 0.5}, 120);
  EXPECT_LE(world.things[0].velocity.linear.norm() + world.things[0].velocity.angular.norm(), 1e-3);
  EXPECT_LE(GapOf(world.things[0], {1, 0, 0.5}), 1e-3);
  // by hand: it carries the weight, m g h
  EXPECT_NEAR(world.joints.impulses_of(0)[1], 2 * 9.81 / 60, 1e-4);
}

TEST(Joints, SpringRestsWhereItCarriesTheWeight) {
  JointKind kind;
  kind.linear[1] = {.rest = 0.25, .frequency = 2, .damping_ratio = 1};
  const SmallWorld world = Drive(kind, {0, 0, 0}, 240);
  const double omega = 2 * kPi * 2;
  EXPECT_NEAR(world.things[0].position.y(), 0.25 - 9.81 / (omega * omega), 1e-4);
}

TEST(Joints, SpringSwingsAtItsFrequency) {
  JointKind kind;
  kind.linear[1] = {.rest = 0, .frequency = 1, .damping_ratio = 0};
  SmallWorld world;
  world.h = 1e-3;
  world.gravity = 0;
  world.things.push_back({.position = {0, 1, 0}});
  for (int i = 0; i < 500; ++i) {
    world.Step([&](SmallWorld* w) { Hold(kind, Vector3d::Zero(), w); });
  }
  // half a period; an implicit step loses pi^2 f h of the height in one
  EXPECT_NEAR(world.things[0].position.y(), -1, 0.012);
}

TEST(Joints, SpringIsNoStrongerThanItsMost) {
  JointKind kind;
  kind.linear[1] = {.frequency = 20, .spring_most = 2 * 9.81 / 2};
  const SmallWorld world = Drive(kind, {0, 0, 0}, 60);
  EXPECT_NEAR(world.things[0].velocity.linear.y(), -9.81 / 2, 1e-3);
}

TEST(Joints, ServoTurnsToItsTarget) {
  const SmallWorld world = Drive(HingeJoint({.rest = 2.5, .frequency = 2}), {0, 0, 0}, 180);
  EXPECT_NEAR(AngleAboutX(world.things[0]), 2.5, 1e-3);
}

TEST(Joints, ConeStopsASwing) {
  // a pendulum along -y that is thrown sideways; its x axis turns with it
  for (const double cone : {0.3, 0.9}) {
    SmallWorld world;
    world.gravity = 0;
    world.things.push_back({.velocity = {.angular = {0, 0, 2}}});
    double most = 0;
    for (int i = 0; i < 120; ++i) {
      world.Step([&](SmallWorld* w) {
        Hold(ConeTwistJoint(cone, {.lo = -0.2, .hi = 0.2}), Vector3d::Zero(), w);
      });
      const Vector3d x = world.things[0].turn * Vector3d::UnitX();
      most = std::max(most, std::acos(std::min(1.0, x.x())));
    }
    EXPECT_NEAR(most, cone, 2e-3);
  }
}

TEST(Joints, TwistIsLimitedWhileTheyAreBent) {
  SmallWorld world;
  world.gravity = 0;
  world.things.push_back({});
  world.things[0].turn = Eigen::AngleAxisd(0.5, Vector3d::UnitZ());
  world.things[0].velocity.angular = 3 * (world.things[0].turn * Vector3d::UnitX());
  for (int i = 0; i < 60; ++i) {
    world.Step([&](SmallWorld* w) {
      Hold(ConeTwistJoint(1, {.lo = -0.2, .hi = 0.2}), Vector3d::Zero(), w);
    });
    const Eigen::Quaterniond& q = world.things[0].turn;
    EXPECT_LE(2 * std::atan2(q.x(), q.w()), 0.23);
  }
}

TEST(Joints, DistanceIsARodOrARope) {
  for (const JointAxis length : {JointAxis{.lo = 1, .hi = 1}, JointAxis{.hi = 1}}) {
    SmallWorld world;
    world.things.push_back({.position = {0.6, -0.8, 0}});
    const auto fill = [&](SmallWorld* w) {
      w->joints.AddDistance(length, w->things[0].Side(0, Vector3d::Zero()), {}, 1);
    };
    for (int i = 0; i < 100; ++i) {
      world.Step(fill);
      EXPECT_NEAR(world.things[0].position.norm(), 1, 0.02);
    }
  }
  // a rope that is slack does nothing
  SmallWorld world;
  world.things.push_back({.position = {0, -0.5, 0}});
  world.Step([](SmallWorld* w) {
    w->joints.AddDistance({.hi = 1}, w->things[0].Side(0, Vector3d::Zero()), {}, 1);
  });
  EXPECT_NEAR(world.things[0].velocity.linear.y(), -9.81 / 60, 1e-6);
}

TEST(Joints, GiveAndTakeTheSameMomentum) {
  SmallWorld world;
  world.gravity = 0;
  world.things = {{.position = {0.05, 0, 0}, .velocity = {.linear = {0, 2, 1}}},
                  {.mass = 5, .position = {1, 0, 0}, .inertia = 3}};
  const auto momentum = [&world] {
    Vector3d turning = Vector3d::Zero();
    for (const Thing& t : world.things) {
      turning += t.mass * t.position.cross(t.velocity.linear) + t.inertia * t.velocity.angular;
    }
    return turning;
  };
  const Vector3d before = momentum();
  world.Step([](SmallWorld* w) {
    const Vector3d middle(0.5, 0.1, 0);
    const auto side = [&](int i) { return w->things[i].Side(i, middle - w->things[i].position); };
    w->joints.Add(HingeJoint({.speed = 1, .motor_most = 3}), side(0), side(1), 1);
  });
  // positions moved with the velocities: take that out
  for (Thing& t : world.things) t.position -= world.h * t.velocity.linear;
  EXPECT_LE((momentum() - before).norm(), 1e-5);
}

TEST(Joints, StartFromWhatTheyExerted) {
  Joints joints;
  const std::array bodies{Body{.inv_mass = 1, .inv_inertia = Eigen::Matrix3d::Identity()}};
  const StepInput step{bodies, 0.01};
  joints.Begin(step);
  EXPECT_EQ(joints.Add(BallJoint(), {.body = 0}, {}, 3), 0);
  EXPECT_EQ(joints.Add(HingeJoint(), {.body = 0}, {}, 2), 1);
  for (size_t i = 0; i < joints.impulses().size(); ++i)
    joints.impulses()[i] = 1 + static_cast<float>(i);

  joints.Begin(step);
  joints.Add(FixedJoint(), {.body = 0}, {}, 2);  // more rows than it had
  joints.Add(BallJoint(), {.body = 0}, {}, 3);
  joints.Add(BallJoint(), {.body = 0}, {}, 0);
  EXPECT_EQ(joints.impulses_of(0)[0], 0);
  EXPECT_EQ(joints.impulses_of(1)[2], 3);
  EXPECT_EQ(joints.impulses_of(2)[2], 0);
}

TEST(Joints, ThatHoldNothingAreNone) {
  Joints joints;
  const std::array bodies{Body{.inv_mass = 1}};
  joints.Begin({bodies, 0.01});
  EXPECT_EQ(joints.Add({}, {.body = 0}, {}, 1), -1);
  EXPECT_TRUE(joints.joints().empty());
}

TEST(Joints, AnglesAreThoseOfTheLibrary) {
  for (int i = -1000; i <= 1000; ++i) {
    const double angle = i * kPi / 1000, length = 1 + std::abs(i);
    const double y = length * std::sin(angle), x = length * std::cos(angle);
    EXPECT_NEAR(ArcTan2(y, x), std::atan2(y, x), 2e-15) << i;
  }
  EXPECT_EQ(ArcTan2(0, 0), 0);
  EXPECT_EQ(ArcTan2(0, -1), kPi);
  EXPECT_NEAR(WrapAngle(1.5 * kPi), -0.5 * kPi, 1e-15);
  EXPECT_NEAR(WrapAngle(-1.5 * kPi), 0.5 * kPi, 1e-15);
}

}  // namespace
}  // namespace cairn
