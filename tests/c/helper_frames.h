// SPDX-License-Identifier: MIT
// What an engine would give to the helpers, at random, and the same in C.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <random>
#include <vector>

#include "cairn/cairn_helpers.h"
#include "cairn/joints.h"

namespace cairn::test {

using Eigen::Vector3d;

// In C, field by field: a layout that changes is seen.

inline void Put(const Vector3& from, double* to) {
  for (int k = 0; k < 3; ++k) to[k] = from[k];
}

inline CairnTouch ToC(const Touch& from) {
  CairnTouch to = cairnDefaultTouch();
  to.bodyA = from.body_a;
  to.bodyB = from.body_b;
  Put(from.centre_a, to.centreA);
  Put(from.centre_b, to.centreB);
  Put(from.normal, to.normal);
  to.friction = from.friction;
  to.restitution = from.restitution;
  to.id = from.id;
  return to;
}

inline CairnTouchPoint ToC(const TouchPoint& from) {
  CairnTouchPoint to = cairnDefaultTouchPoint();
  Put(from.position, to.position);
  to.depth = from.depth;
  to.feature = from.feature;
  return to;
}

inline CairnContactOptions ToC(const ContactOptions& from) {
  return {.slop = from.slop,
          .erp = from.erp,
          .maxPush = from.max_push,
          .maxGap = from.max_gap,
          .minBounce = from.min_bounce,
          .frequency = from.frequency,
          .dampingRatio = from.damping_ratio};
}

inline CairnJointAxis ToC(const JointAxis& from) {
  return {.lo = from.lo,
          .hi = from.hi,
          .speed = from.speed,
          .maxMotorForce = from.max_motor_force,
          .rest = from.rest,
          .frequency = from.frequency,
          .dampingRatio = from.damping_ratio,
          .maxSpringForce = from.max_spring_force};
}

inline CairnJointKind ToC(const JointKind& from) {
  CairnJointKind to = cairnDefaultJointKind();
  for (int k = 0; k < 3; ++k) to.linear[k] = ToC(from.linear[k]);
  to.twist = ToC(from.twist);
  to.cone = from.cone;
  return to;
}

inline CairnJointSide ToC(const JointSide& from) {
  CairnJointSide to = cairnDefaultJointSide();
  to.body = from.body;
  Put(from.centre, to.centre);
  Put(from.anchor, to.anchor);
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 0; k < 3; ++k) to.axes[axis][k] = from.axes(k, axis);
  }
  return to;
}

inline CairnJointGear ToC(const JointGear& from) {
  CairnJointGear to = cairnDefaultJointGear();
  to.side = ToC(from.side);
  to.angle = from.angle;
  to.teeth = from.teeth;
  return to;
}

template <class BodyOfC>
BodyOfC ToC(const Body& from, BodyOfC to) {
  using Number = decltype(to.invMass);
  to.invMass = static_cast<Number>(from.inv_mass);
  for (int k = 0; k < 9; ++k) {
    to.invInertia[k] = static_cast<Number>(from.inv_inertia(k / 3, k % 3));
  }
  for (int k = 0; k < 3; ++k) {
    to.velocity.linear[k] = static_cast<Number>(from.velocity.linear[k]);
    to.velocity.angular[k] = static_cast<Number>(from.velocity.angular[k]);
    to.impulse[k] = static_cast<Number>(from.impulse[k]);
    to.angularImpulse[k] = static_cast<Number>(from.angular_impulse[k]);
  }
  to.id = from.id;
  return to;
}

/// A joint of any form.
struct AnyJoint {
  enum { kKind, kDistance, kGear } form = kKind;
  JointKind kind = {};
  JointAxis length = {};
  int teeth[2] = {12, -7};
};

inline std::vector<AnyJoint> AllKinds() {
  const JointAxis all{.lo = -0.1,
                      .hi = 0.3,
                      .speed = 0.7,
                      .max_motor_force = 2,
                      .rest = 0.1,
                      .frequency = 3,
                      .damping_ratio = 0.4,
                      .max_spring_force = 9};
  const JointAxis servo{.rest = 2.9, .frequency = 1.5};
  JointKind six_ways = ConeTwistJoint(0.05, all);
  for (JointAxis& axis : six_ways.linear) axis = all;
  six_ways.linear[1] = servo;
  return {{.kind = BallJoint()},
          {.kind = HingeJoint()},
          {.kind = HingeJoint(all)},
          {.kind = HingeJoint(servo)},
          {.kind = SliderJoint(all)},
          {.kind = FixedJoint()},
          {.kind = ConeTwistJoint(0.2, all)},
          {.kind = six_ways},
          {.kind = {}},  // holds nothing
          {.form = AnyJoint::kDistance, .length = {.lo = 1, .hi = 1}},
          {.form = AnyJoint::kDistance, .length = all},
          {.form = AnyJoint::kGear}};
}

/// Bodies on random ways, with contacts and joints between each and the next, or the world.
class RandomFrames {
 public:
  explicit RandomFrames(std::uint32_t seed) : random_(seed) {
    for (int i = 0; i < kBodies; ++i) {
      Body& body = bodies.emplace_back();
      body.inv_mass = 1 / Number(0.5, 3);
      body.inv_inertia = Matrix3::Diagonal(Number(1, 4), Number(1, 4), Number(1, 4));
      body.velocity = {Any(2), Any(2)};
      body.impulse = {0, -9.81 / 60 / body.inv_mass, 0};
      body.id = static_cast<std::uint64_t>(i + 1);
    }
  }

  static constexpr int kBodies = 24;

  Touch NextTouch(int i) {
    return {.body_a = i,
            .body_b = i % 5 == 0 ? kWorld : i - 1,
            .centre_a = Any(100),
            .centre_b = Any(100),
            .normal = View3(Any(1)).normalized(),
            .friction = i % 3 == 0 ? 0 : Number(0, 1),
            .restitution = i % 2 == 0 ? 0 : Number(0, 1),
            .id = static_cast<std::uint64_t>(i + 1)};
  }
  std::vector<TouchPoint> NextPoints(const Touch& touch, int count) {
    std::vector<TouchPoint> points;
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(count); ++k) {
      const Vector3d at = View3(touch.centre_a) + View3(Any(0.5));
      points.push_back({.position = at, .depth = Number(-0.12, 0.05), .feature = count - k});
    }
    return points;
  }
  JointSide NextSide(int body) {
    const Vector3 centre = Any(100);
    const Eigen::AngleAxisd turn(Number(-3, 3), View3(Any(1)).normalized());
    return {.body = body,
            .centre = centre,
            .anchor = Vector3d(View3(centre) + View3(Any(0.5))),
            .axes = turn.toRotationMatrix()};
  }
  double Number(double lo, double hi) {
    return lo + (hi - lo) * (static_cast<double>(random_()) / 4294967296.0);
  }

  std::vector<Body> bodies;

 private:
  static Vector3d View3(const Vector3& v) { return {v[0], v[1], v[2]}; }
  Vector3 Any(double size) {
    return {Number(-size, size), Number(-size, size), Number(-size, size)};
  }

  std::mt19937 random_;
};

}  // namespace cairn::test
