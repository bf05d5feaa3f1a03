// SPDX-License-Identifier: MIT
// Joints from anchors and axes: one law for each kind, signs, targets and limits.
#include "cairn/joints.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>
#include <vector>

#include "cairn/detail/eigen.h"
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
  EXPECT_GT(View(world.things[0].velocity.angular).norm(), 1);
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

// By hand: anchors 3 and 4 cm apart along two axes, axes turned by 0.2 rad, a limit passed by 0.3
// m.
TEST(Joints, SayHowFarApartTheyAre) {
  const std::array<Body, 1> bodies{};
  Joints joints(0.25);
  joints.Begin({.bodies = bodies});
  const JointSide side{.body = 0, .anchor = {0.03, 0, 0.04}}, far{.body = 0, .anchor = {0.8, 0, 0}};
  JointSide turned{.body = 0};
  turned.axes = Eigen::AngleAxisd(0.2, Vector3d::UnitY()).toRotationMatrix();
  joints.Add(BallJoint(), side, {}, 1);
  EXPECT_NEAR(joints.worst_gap().largest, 0.05, 1e-12);
  EXPECT_NEAR(joints.worst_gap().taken_back, 0.0125, 1e-12);
  EXPECT_EQ(joints.worst_angle().largest, 0);
  joints.Add(FixedJoint(), turned, {}, 2);
  EXPECT_NEAR(joints.worst_gap().largest, 0.05, 1e-12);
  EXPECT_NEAR(joints.worst_angle().largest, 0.2, 1e-9);
  EXPECT_NEAR(joints.worst_angle().taken_back, 0.05, 1e-9);
  joints.Add(SliderJoint({.hi = 0.5}), far, {}, 3);
  EXPECT_NEAR(joints.worst_gap().largest, 0.3, 1e-12);
  joints.Begin({.bodies = bodies});
  joints.Add(SliderJoint({.hi = 0.9}), far, {}, 3);
  joints.Add(SliderJoint({.speed = 1, .max_motor_force = 1}), far, {}, 4);
  EXPECT_EQ(joints.worst_gap().largest, 0) << "what is free is no error";
}

// A swing of 10 m/s about a metre leaves its circle by 14 mm in a step of 1/60 s; a fifth is taken
// back in each. The residual, of velocities, says nothing of that.
TEST(Joints, SayWhatResidualsDoNot) {
  SmallWorld world;
  world.gravity = 0;
  const Vector3d anchor(1, 0, 0);
  world.things.push_back({.position = -anchor});
  world.things[0].velocity = {.linear = {0, 10, 0}, .angular = {0, 0, -10}};
  for (int i = 0; i < 60; ++i) {
    world.Step([&](SmallWorld* w) { Hold(BallJoint(), anchor, w); });
    EXPECT_LE(world.report.residual_max, 1e-4);
  }
  EXPECT_GT(world.joints.worst_gap().largest, 0.03);
  EXPECT_NEAR(world.joints.worst_gap().largest, GapOf(world.things[0], anchor), 0.005);
}

// By hand: a fifth of 10 cm in 1/60 s is 1.2 m/s, a fifth of 0.2 rad 2.4 rad/s; a box that only
// this joint holds does all of it. What residuals leave out, the report says.
TEST(Joints, AreAskedForTheirGapsInTheReport) {
  SmallWorld world;
  world.gravity = 0;
  world.things.push_back({.position = {0.1, 0, 0}});
  world.things[0].turn = Eigen::AngleAxisd(0.2, Vector3d::UnitY());
  world.Step([](SmallWorld* w) { Hold(FixedJoint(), Vector3d::Zero(), w); });
  EXPECT_NEAR(world.report.gap.asked, 1.2, 1e-6);
  EXPECT_NEAR(world.report.gap.done, 1.2, 1e-4);
  EXPECT_NEAR(world.report.angle.asked, 2.4, 1e-5);
  EXPECT_NEAR(world.report.angle.done, 2.4, 2e-4);
  EXPECT_EQ(world.report.depth.asked, 0);
}

// Rods pull two balls together, by a fifth of 6 cm and of 12 cm. Without a sweep nothing is done. A
// motor and a limit that is far are no errors.
TEST(Joints, SayInTheReportWhatTheyDoNotDo) {
  for (const int sweeps : {0, 100}) {
    SmallWorld world;
    world.gravity = 0;
    world.solver.settings().max_sweeps = sweeps;
    world.things = {{}, {.position = {1.06, 0, 0}}, {.position = {0, 5, 0}}};
    world.Step([](SmallWorld* w) {
      const auto side = [w](int body) { return w->things[body].Side(body, Vector3d::Zero()); };
      const JointAxis rod{.lo = 1, .hi = 1}, motor{.lo = -3, .speed = 40, .max_motor_force = 9};
      w->joints.AddDistance(rod, side(0), side(1), 0);
      w->joints.AddDistance({.lo = 4.88, .hi = 4.88}, side(2), {}, 0);
      w->joints.Add(HingeJoint(motor), side(0), {}, 0);
    });
    EXPECT_NEAR(world.report.gap.asked, 1.44, 1e-5);
    EXPECT_NEAR(world.report.gap.done, sweeps == 0 ? 0 : 1.44, 1e-3);
    EXPECT_EQ(world.report.angle.asked, 0);
  }
}

TEST(Joints, HingeTurnsAboutXOnly) {
  // an arm along z under gravity turns about x; one along x cannot
  const SmallWorld swings = Drive(HingeJoint(), {0, 0, 1}, 20);
  EXPECT_GT(swings.things[0].velocity.angular.x() * -1, 0.5);
  const SmallWorld held = Drive(HingeJoint(), {1, 0, 0}, 60);
  EXPECT_LE(View(held.things[0].velocity.angular).norm(), 1e-3);
  EXPECT_LE(held.things[0].position.y() * -1, 2e-3);
}

TEST(Joints, MotorTurnsByTheRightHandWithItsTorque) {
  // I w = torque t, here about an axis through the centre; I = 0.4
  const SmallWorld weak = Drive(HingeJoint({.speed = 100, .max_motor_force = 0.8}), {0, 0, 0}, 30);
  EXPECT_NEAR(weak.things[0].velocity.angular.x(), 0.8 / 0.4 * 0.5, 1e-4);
  const SmallWorld strong = Drive(HingeJoint({.speed = -3, .max_motor_force = 1e4}), {0, 0, 0}, 30);
  EXPECT_NEAR(strong.things[0].velocity.angular.x(), -3, 1e-4);
  EXPECT_NEAR(AngleAboutX(strong.things[0]), -1.5, 1e-3);
}

TEST(Joints, LimitsStopBothWays) {
  for (const double speed : {2.0, -2.0}) {
    const JointAxis about{.lo = -0.5, .hi = 0.75, .speed = speed, .max_motor_force = 10};
    const SmallWorld world = Drive(HingeJoint(about), {0, 0, 0}, 60);
    EXPECT_NEAR(AngleAboutX(world.things[0]), speed > 0 ? 0.75 : -0.5, 1e-4);
    EXPECT_LE(View(world.things[0].velocity.angular).norm(), 1e-4);
  }
}

// A button that is hit hard would pass the other limit within the step.
TEST(Joints, NarrowLimitsStopBothWaysAtOnce) {
  for (const double speed : {5.0, -29.0}) {
    SmallWorld world;
    world.gravity = 0;
    world.things.push_back({.mass = 2});
    world.things[0].velocity.linear[0] = speed;
    for (int i = 0; i < 30; ++i) {
      world.Step([](SmallWorld* w) { Hold(SliderJoint({.lo = -0.02, .hi = 0.02}), {0, 0, 0}, w); });
      EXPECT_LE(std::abs(world.things[0].position.x()), 0.02 + 1e-6) << speed << " at " << i;
    }
    EXPECT_NEAR(world.things[0].position.x(), speed > 0 ? 0.02 : -0.02, 1e-6);
  }
}

// A limit and a motor that asks for more than it leaves have no solution: both pulled at the joint.
TEST(Joints, MotorsWithoutALimitOfTheirOwnStopAtLimits) {
  for (const double speed : {2.0, -2.0, 100.0}) {
    const JointAxis axis{.lo = -0.5, .hi = 0.75, .speed = speed, .max_motor_force = kInfinity};
    const double end = speed > 0 ? 0.75 : -0.5;
    const SmallWorld hinge = Drive(HingeJoint(axis), {0, 0, 0}, 120);
    EXPECT_NEAR(AngleAboutX(hinge.things[0]), end, 1e-4) << speed;
    const SmallWorld slider = Drive(SliderJoint(axis), {0, 0, 0}, 120);
    EXPECT_NEAR(slider.things[0].position.x(), end, 1e-4) << speed;
  }
  // from beyond the limit it comes back as without a motor
  SmallWorld world;
  world.gravity = 0;
  world.things.push_back({.position = {1, 0, 0}});
  const JointAxis axis{.hi = 0.5, .speed = 3, .max_motor_force = kInfinity};
  world.Step([&axis](SmallWorld* w) { Hold(SliderJoint(axis), Vector3d::Zero(), w); });
  EXPECT_NEAR(world.things[0].position.x(), 0.9, 1e-6);
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
  const SmallWorld world =
      Drive(SliderJoint({.speed = 100, .max_motor_force = 4}), {0, 0.3, 0}, 30);
  const Thing& thing = world.things[0];
  EXPECT_NEAR(thing.velocity.linear.x(), 4 / 2.0 * 0.5, 1e-3);
  EXPECT_NEAR(thing.position.y(), -0.3, 1e-4);
  EXPECT_LE(View(thing.velocity.angular).norm(), 1e-3);
}

TEST(Joints, FixedHoldsALever) {
  const SmallWorld world = Drive(FixedJoint(), {1, 0, 0.5}, 120);
  EXPECT_LE(
      View(world.things[0].velocity.linear).norm() + View(world.things[0].velocity.angular).norm(),
      1e-3);
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
  kind.linear[1] = {.frequency = 20, .max_spring_force = 2 * 9.81 / 2};
  const SmallWorld world = Drive(kind, {0, 0, 0}, 60);
  EXPECT_NEAR(world.things[0].velocity.linear.y(), -9.81 / 2, 1e-3);
}

TEST(Joints, ServoTurnsToItsTarget) {
  const SmallWorld world = Drive(HingeJoint({.rest = 2.5, .frequency = 2}), {0, 0, 0}, 180);
  EXPECT_NEAR(AngleAboutX(world.things[0]), 2.5, 1e-3);
}

TEST(Joints, LimitsHoldAtHalfATurnAndBeyond) {
  for (const auto& [lo, hi, speed, start] : {std::tuple(0.0, kPi, 1.0, 0.0),
                                             {0.0, kPi, 8.0, 0.0},
                                             {-kPi, 0.0, -1.0, 0.0},
                                             {kPi / 2, 3 * kPi / 2, 2.0, 2.0}}) {
    SmallWorld world;
    world.gravity = 0;
    world.things.push_back({.mass = 2, .position = Vector3d::Zero()});
    world.things[0].turn = Eigen::AngleAxisd(start, Vector3d::UnitX());
    const JointAxis about{.lo = lo, .hi = hi, .speed = speed, .max_motor_force = 50};
    double turned = start;  // whole turns count
    for (int i = 0; i < 300; ++i) {
      world.Step([&](SmallWorld* w) { Hold(HingeJoint(about), Vector3d::Zero(), w); });
      turned += world.h * world.things[0].velocity.angular.x();
    }
    const double wanted = speed < 0 ? lo : hi;
    EXPECT_NEAR(turned, wanted, 1e-3) << lo << " to " << hi << " from " << start;
    EXPECT_LE(View(world.things[0].velocity.angular).norm(), 1e-3);
  }
}

TEST(Joints, SpringsTurnTheShortWay) {
  for (const auto& [rest, start, end] :
       {std::tuple(kPi, 3.0, kPi), {3.0, -3.0, 3.0 - 2 * kPi}, {-3.0, 3.0, 2 * kPi - 3.0}}) {
    SmallWorld world;
    world.gravity = 0;
    world.things.push_back({.mass = 2, .position = Vector3d::Zero()});
    world.things[0].turn = Eigen::AngleAxisd(start, Vector3d::UnitX());
    double turned = start;
    for (int i = 0; i < 300; ++i) {
      world.Step([rest = rest](SmallWorld* w) {
        Hold(HingeJoint({.rest = rest, .frequency = 2}), Vector3d::Zero(), w);
      });
      turned += world.h * world.things[0].velocity.angular.x();
    }
    EXPECT_NEAR(turned, end, 5e-3) << rest << " from " << start;
  }
}

TEST(Joints, SpringsAreAsStiffWithSubsteps) {
  const double omega = 2 * kPi * 2, sag = 9.81 / (omega * omega);
  JointKind spring;
  spring.linear[1] = {.frequency = 2};
  for (const int substeps : {1, 2, 4, 16}) {
    SmallWorld world;
    world.solver.settings().substeps = substeps;
    world.things = {{.mass = 2, .position = {0, 0, 0}}, {.mass = 2, .position = {5, -3, 0}}};
    for (int i = 0; i < 240; ++i) {
      world.Step([&](SmallWorld* w) {
        Hold(spring, Vector3d::Zero(), w);
        const JointSide bob = w->things[1].Side(1, Vector3d::Zero());
        w->joints.AddDistance({.rest = 3, .frequency = 2}, bob, {.anchor = Vector3d(5, 0, 0)}, 2);
      });
    }
    EXPECT_NEAR(world.things[0].position.y(), -sag, 1e-4) << substeps << " substeps";
    EXPECT_NEAR(world.things[1].position.y(), -3 - sag, 1e-4) << substeps << " substeps";
  }
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
  // a rope that is w does nothing
  SmallWorld world;
  world.things.push_back({.position = {0, -0.5, 0}});
  world.Step([](SmallWorld* w) {
    w->joints.AddDistance({.hi = 1}, w->things[0].Side(0, Vector3d::Zero()), {}, 1);
  });
  EXPECT_NEAR(world.things[0].velocity.linear.y(), -9.81 / 60, 1e-6);
}

TEST(Joints, TwistOfIsTheTurnAboutX) {
  for (const double angle : {-3.0, -0.5, 0.0, 1.25, 3.1}) {
    JointSide turned;
    turned.axes = Eigen::AngleAxisd(angle, Vector3d::UnitX()).toRotationMatrix();
    EXPECT_NEAR(TwistOf(turned, {}), angle, 1e-12);
    EXPECT_NEAR(TwistOf({}, turned), -angle, 1e-12);
  }
}

// By hand: 20 teeth against 30. Both turn by w_a + 1.5 w_b = -erp C / h, where C is what 20 times
// the angle of a and 30 times that of b are off a whole turn, as an angle of a: 20 x 0.04 - 30 x
// 0.02 = 0.2, by 20 is 0.01 rad.
TEST(Joints, GearHasOneRowOfBothTurns) {
  Joints joints(0.5);
  const std::array bodies{Body{.inv_mass = 1, .inv_inertia = Eigen::Matrix3d::Identity()},
                          Body{.inv_mass = 1, .inv_inertia = Eigen::Matrix3d::Identity()}};
  joints.Begin({bodies, 0.01});
  JointSide across{.body = 1};
  across.axes = Eigen::AngleAxisd(kPi / 2, Vector3d::UnitY()).toRotationMatrix();
  EXPECT_EQ(joints.AddGear({{.body = 0}, 0.04, 20}, {across, -0.02, 30}, 1), 0);
  ASSERT_EQ(joints.rows().size(), size_t{1});
  const JointRow& row = joints.rows()[0];
  EXPECT_TRUE(Vector3d(row.angular_a[0], row.angular_a[1], row.angular_a[2])
                  .isApprox(Vector3d(1, 0, 0), 1e-6));
  EXPECT_TRUE(Vector3d(row.angular_b[0], row.angular_b[1], row.angular_b[2])
                  .isApprox(Vector3d(0, 0, -1.5), 1e-6));
  EXPECT_EQ(Vector3d(row.linear_a[0], row.linear_a[1], row.linear_a[2]), Vector3d::Zero());
  EXPECT_NEAR(row.target, -0.5 * 0.01 / 0.01, 1e-6);
  EXPECT_EQ(joints.joints()[0].angular, 1u);
  EXPECT_EQ(joints.joints()[0].bounded, 0u);
  EXPECT_EQ(joints.joints()[0].errors, 1u);
}

// A whole turn of either is no error, and half a tooth is the most.
TEST(Joints, GearMeshesAnyTooth) {
  const std::array bodies{Body{.inv_mass = 1, .inv_inertia = Eigen::Matrix3d::Identity()}};
  const auto target = [&](double angle_a, double angle_b) {
    Joints joints(1);
    joints.Begin({bodies, 1});
    joints.AddGear({{.body = 0}, angle_a, 12}, {{}, angle_b, -5}, 1);
    return static_cast<double>(joints.rows()[0].target);
  };
  const double tooth = 2 * kPi / 12;
  EXPECT_NEAR(target(0, 0), 0, 1e-6);
  EXPECT_NEAR(target(3 * tooth, 0), 0, 1e-6);
  EXPECT_NEAR(target(2 * kPi, -2 * kPi), 0, 1e-6);
  EXPECT_NEAR(target(tooth / 4, 0), -tooth / 4, 1e-6);
  EXPECT_NEAR(target(3 * tooth / 4, 0), tooth / 4, 1e-6);
  EXPECT_NEAR(target(0, 2 * kPi / 5 / 4), tooth / 4, 1e-6);
}

/// Wheels on hinges along x in the world, of so many teeth; wheel 0 has a motor of 2 rad/s. Each
/// meshes with the next, and the last with the first if @p closed.
SmallWorld Wheels(const std::vector<int>& teeth, bool closed, int steps) {
  SmallWorld world;
  const int count = static_cast<int>(teeth.size());
  for (int i = 0; i < count; ++i) world.things.push_back({.position = {0, 2.0 * i, 0}});
  for (int step = 0; step < steps; ++step) {
    world.Step([&](SmallWorld* w) {
      std::vector<JointGear> gears;
      for (int i = 0; i < count; ++i) {
        const JointSide wheel = w->things[i].Side(i, Vector3d::Zero());
        const JointSide axle{.anchor = {0, 2.0 * i, 0}};
        const JointAxis motor{.speed = 2, .max_motor_force = 20};
        w->joints.Add(HingeJoint(i == 0 ? motor : JointAxis{}), wheel, axle, i + 1);
        gears.push_back({wheel, TwistOf(wheel, axle), teeth[i]});
      }
      for (int i = 0; i + (closed ? 0 : 1) < count; ++i) {
        w->joints.AddGear(gears[i], gears[(i + 1) % count], 100 + i);
      }
    });
  }
  return world;
}

TEST(Joints, GearsPassOnTurnsByTheirTeeth) {
  // ten seconds: three turns of the first
  const SmallWorld world = Wheels({20, 40, 10}, false, 600);
  const double speeds[] = {2, -1, 4};
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(world.things[i].velocity.angular.x(), speeds[i], 1e-3) << i;
  }
  // teeth have passed as they came: by hand, 20 a + 40 b and 40 b + 10 c are whole turns
  const double a = AngleAboutX(world.things[0]), b = AngleAboutX(world.things[1]);
  const double c = AngleAboutX(world.things[2]);
  EXPECT_NEAR(std::remainder(20 * a + 40 * b, 2 * kPi) / 20, 0, 1e-3);
  EXPECT_NEAR(std::remainder(40 * b + 10 * c, 2 * kPi) / 10, 0, 1e-3);
}

TEST(Joints, ARingOfGearsTurnsIfTheirNumberIsEven) {
  const SmallWorld four = Wheels({8, 16, 8, 16}, true, 240);
  EXPECT_NEAR(four.things[0].velocity.angular.x(), 2, 1e-3);
  EXPECT_NEAR(four.things[2].velocity.angular.x(), 2, 1e-3);
  const SmallWorld three = Wheels({8, 16, 8}, true, 240);
  for (const Thing& wheel : three.things) EXPECT_LE(View(wheel.velocity.angular).norm(), 1e-3);
}

TEST(Joints, GiveAndTakeTheSameMomentum) {
  SmallWorld world;
  world.gravity = 0;
  world.things = {{.position = {0.05, 0, 0}, .velocity = {.linear = {0, 2, 1}}},
                  {.mass = 5, .position = {1, 0, 0}, .inertia = 3}};
  const auto momentum = [&world] {
    Vector3d turning = Vector3d::Zero();
    for (const Thing& t : world.things) {
      turning +=
          t.mass * t.position.cross(View(t.velocity.linear)) + t.inertia * View(t.velocity.angular);
    }
    return turning;
  };
  const Vector3d before = momentum();
  world.Step([](SmallWorld* w) {
    const Vector3d middle(0.5, 0.1, 0);
    const auto side = [&](int i) { return w->things[i].Side(i, middle - w->things[i].position); };
    w->joints.Add(HingeJoint({.speed = 1, .max_motor_force = 3}), side(0), side(1), 1);
  });
  // positions moved with the velocities: take that out
  for (Thing& t : world.things) t.position -= world.h * View(t.velocity.linear);
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

TEST(Joints, StartALongerStepFromMore) {
  Joints joints;
  const std::array bodies{Body{.inv_mass = 1, .inv_inertia = Eigen::Matrix3d::Identity()}};
  joints.Begin({bodies, 0.01});
  joints.Add(BallJoint(), {.body = 0}, {}, 3);
  joints.impulses()[1] = 2;
  joints.Begin({bodies, 0.03});
  joints.Add(BallJoint(), {.body = 0}, {}, 3);
  EXPECT_FLOAT_EQ(joints.impulses_of(0)[1], 6);
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
