// SPDX-License-Identifier: MIT
// What helpers for engines refuse, how they name it, and that nothing is added or lost by it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "cairn/joints.h"

namespace cairn {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Two bodies that touch, and are jointed.
class BadValueTest : public testing::Test {
 protected:
  BadValueTest() {
    contacts.Begin({.bodies = bodies});
    joints.Begin({.bodies = bodies});
  }

  const std::array<Body, 2> bodies{Body{.inv_mass = 1, .inv_inertia = Matrix3::Diagonal(1, 1, 1)},
                                   Body{.inv_mass = 1, .inv_inertia = Matrix3::Diagonal(1, 1, 1)}};
  Contacts contacts;
  Joints joints{0.2};
  Touch touch{.body_a = 0, .body_b = 1, .id = 1};
  std::array<TouchPoint, 2> points{};
  JointKind kind = BallJoint();
  JointSide a{.body = 0}, b{.body = 1};
};

TEST_F(BadValueTest, OfATouchIsNamed) {
  const auto expect = [this](const char* said) {
    EXPECT_FALSE(contacts.Add(touch, points));
    EXPECT_EQ(contacts.complaint(), said);
    EXPECT_TRUE(contacts.manifolds().empty() && contacts.points().empty());
  };
  touch.restitution = kNaN;
  expect("touch.restitution is nan, must be finite, 0 or more");
  touch.restitution = 0;
  touch.friction = -1;
  expect("touch.friction is -1, must be finite, 0 or more");
  touch.friction = 0.5;
  touch.body_b = 2;
  expect("touch.body_b is 2, must be -1 for the world, or below the count of bodies");
  touch.body_b = 0;
  expect("touch.body_b is 0, must be another body than the first");
  touch.body_b = kWorld;
  touch.centre_b = {kNaN, 0, 0};  // not looked at
  points[1].depth = kNaN;
  expect("points[1].depth is nan, must be finite");
  points[1].depth = 0.01;
  contacts.options().erp = 2;
  expect("options.erp is 2, must be 0 to 1");
  contacts.options() = {};
  EXPECT_TRUE(contacts.Add(touch, points));
  EXPECT_EQ(contacts.complaint(), "");
  EXPECT_EQ(contacts.points().size(), 2);
}

TEST_F(BadValueTest, OfAJointIsNamed) {
  const auto expect = [this](const char* said) {
    EXPECT_EQ(joints.Add(kind, a, b, 1), -1);
    EXPECT_EQ(joints.complaint(), said);
    EXPECT_TRUE(joints.joints().empty() && joints.rows().empty());
  };
  kind.twist.lo = 2;
  kind.twist.hi = 1;
  expect("kind.twist.lo is 2, must be at most hi");
  kind.twist = {.max_motor_force = -1};
  expect("kind.twist.max_motor_force is -1, must be 0 or more");
  kind.twist = {};
  kind.linear[2].speed = kInfinity;
  expect("kind.linear[2].speed is inf, must be finite");
  kind = BallJoint();
  b.anchor = {0, kNaN, 0};
  expect("b.anchor is nan, must be finite");
  b.anchor = {};
  b.body = -2;
  expect("b.body is -2, must be -1 for the world, or below the count of bodies");
  b.body = 1;
  EXPECT_EQ(joints.AddGear({.side = a, .teeth = 0}, {.side = b}, 1), -1);
  EXPECT_EQ(joints.complaint(), "a.teeth is 0, must be another number than 0");
  EXPECT_EQ(joints.AddDistance({.frequency = -1}, a, b, 1), -1);
  EXPECT_EQ(joints.complaint(), "length.frequency is -1, must be finite, 0 or more");
  EXPECT_EQ(joints.Add({}, a, b, 1), -1);  // holds nothing
  EXPECT_EQ(joints.complaint(), "");
  EXPECT_EQ(joints.Add(kind, a, b, 1), 0);

  Joints overshooting{1.5};
  overshooting.Begin({.bodies = bodies});
  EXPECT_EQ(overshooting.Add(kind, a, b, 1), -1);
  EXPECT_EQ(overshooting.complaint(), "erp is 1.5, must be 0 to 1");
}

TEST_F(BadValueTest, LeavesWhatOthersExerted) {
  Touch other = touch;
  other.id = 2;
  for (int frame = 0; frame < 2; ++frame) {
    contacts.Begin({.bodies = bodies});
    other.friction = frame == 1 ? kNaN : 0.5;
    EXPECT_EQ(contacts.Add(other, points), frame == 0);
    EXPECT_TRUE(contacts.Add(touch, points));
    for (ContactImpulse& impulse : contacts.impulses()) {
      EXPECT_EQ(impulse.normal, frame == 0 ? 0 : 3);
      impulse.normal = 3;
    }
  }
}

}  // namespace
}  // namespace cairn
