// SPDX-License-Identifier: MIT
#include "scenes/joints/doll.h"

#include <algorithm>
#include <array>

#include "scenes/joints/joint_frames.h"

namespace cairn::bench {
namespace {

enum Part {
  kPelvis,
  kChest,
  kHead,
  kLeftThigh,
  kLeftShin,
  kRightThigh,
  kRightShin,
  kLeftArm,
  kLeftForearm,
  kRightArm,
  kRightForearm,
  kParts
};

enum class Along { kX, kY, kZ };

struct Capsule {
  double x, y;                  // of the centre [m]
  double radius, length, mass;  // [m], [m] between the centres of the caps, [kg]
  Along axis;
};

constexpr Capsule kCapsules[kParts] = {
    {0, 0.98, 0.14, 0.14, 12, Along::kY},       // pelvis
    {0, 1.26, 0.14, 0.26, 22, Along::kY},       // chest
    {0, 1.66, 0.10, 0.06, 5, Along::kY},        // head
    {-0.14, 0.66, 0.07, 0.36, 8, Along::kY},    // thighs and shins
    {-0.14, 0.24, 0.06, 0.32, 4, Along::kY},    //
    {0.14, 0.66, 0.07, 0.36, 8, Along::kY},     //
    {0.14, 0.24, 0.06, 0.32, 4, Along::kY},     //
    {-0.36, 1.42, 0.06, 0.24, 2.5, Along::kX},  // arms and forearms
    {-0.70, 1.42, 0.05, 0.26, 2, Along::kX},    //
    {0.36, 1.42, 0.06, 0.24, 2.5, Along::kX},   //
    {0.70, 1.42, 0.05, 0.26, 2, Along::kX},     //
};

/// A hinge about an axis, from `low` to `high` [rad].
struct Hinge {
  Part parent, child;
  double x, y;
  Along axis;
  double low, high;
};

constexpr Hinge kHinges[] = {
    {kPelvis, kChest, 0, 1.12, Along::kX, -0.4, 0.8},
    {kLeftThigh, kLeftShin, -0.14, 0.44, Along::kX, 0, 2.2},
    {kRightThigh, kRightShin, 0.14, 0.44, Along::kX, 0, 2.2},
    {kLeftArm, kLeftForearm, -0.53, 1.42, Along::kY, 0, 2.2},
    {kRightArm, kRightForearm, 0.53, 1.42, Along::kY, -2.2, 0},
};

/// A ball joint with a cone of `swing` around an axis, and `twist` about it [rad].
struct Cone {
  Part parent, child;
  double x, y;
  Along axis;
  double swing, twist;
};

constexpr Cone kCones[] = {
    {kChest, kHead, 0, 1.54, Along::kY, 0.6, 0.8},
    {kPelvis, kLeftThigh, -0.14, 0.86, Along::kY, 0.9, 0.4},
    {kPelvis, kRightThigh, 0.14, 0.86, Along::kY, 0.9, 0.4},
    {kChest, kLeftArm, -0.20, 1.42, Along::kX, 1.2, 0.6},
    {kChest, kRightArm, 0.20, 1.42, Along::kX, 1.2, 0.6},
};

constexpr double kHalfPi = 1.57079632679490;
constexpr double kMiddle = 0.95;  // of a doll, above its feet [m]

btVector3 Axis(Along along) {
  return btVector3(along == Along::kX, along == Along::kY, along == Along::kZ);
}

/// The frame at (x, y) of a standing doll whose axis `from` points along `to`.
btTransform FrameAt(double x, double y, Along from, Along to) {
  const btVector3 origin(btScalar(x), btScalar(y), 0);
  if (from == to) return btTransform(btQuaternion::getIdentity(), origin);
  return btTransform(btQuaternion(Axis(from).cross(Axis(to)), btScalar(kHalfPi)), origin);
}

btTransform StandingPose(const Capsule& part) {
  return FrameAt(part.x, part.y, Along::kY, part.axis);
}

using Bodies = std::array<btRigidBody*, kParts>;

/// Bullet's hinges turn about z of their frames.
void AddHinge(World* world, const Bodies& bodies, const Hinge& hinge, const btTransform& pose) {
  btRigidBody *const a = bodies[hinge.parent], *const b = bodies[hinge.child];
  const btTransform frame = pose * FrameAt(hinge.x, hinge.y, Along::kZ, hinge.axis);
  auto joint = std::make_unique<btHingeConstraint>(*a, *b, Local(*a, frame), Local(*b, frame));
  joint->setLimit(btScalar(hinge.low), btScalar(hinge.high));
  world->AddJoint(std::move(joint), ConnectedBodies::kPassThrough);
}

/// Bullet's cones open along x of their frames.
void AddCone(World* world, const Bodies& bodies, const Cone& cone, const btTransform& pose) {
  btRigidBody *const a = bodies[cone.parent], *const b = bodies[cone.child];
  const btTransform frame = pose * FrameAt(cone.x, cone.y, Along::kX, cone.axis);
  auto joint = std::make_unique<btConeTwistConstraint>(*a, *b, Local(*a, frame), Local(*b, frame));
  joint->setLimit(btScalar(cone.swing), btScalar(cone.swing), btScalar(cone.twist));
  world->AddJoint(std::move(joint), ConnectedBodies::kPassThrough);
}

}  // namespace

int DollParts() { return kParts; }

double DollMass() {
  double mass = 0;
  for (const Capsule& part : kCapsules) mass += part.mass;
  return mass;
}

double DollTop(const btTransform& pose) {
  double top = 0;
  for (const Capsule& part : kCapsules) {
    top = std::max<double>(top, (pose * StandingPose(part)).getOrigin().y());
  }
  return top;
}

btTransform LyingDoll(const btVector3& centre, int right_angles, btScalar tilt) {
  const btScalar turn = btScalar(kHalfPi) * btScalar(right_angles);
  const btQuaternion rotation = btQuaternion(btVector3(0, 1, 0), turn) *
                                btQuaternion(btVector3(1, 0, 0), tilt - btScalar(kHalfPi));
  return btTransform(rotation, centre) * At(0, btScalar(-kMiddle), 0);
}

void AddDoll(World* world, const btTransform& pose) {
  Bodies bodies;
  for (int i = 0; i < kParts; ++i) {
    const Capsule& part = kCapsules[i];
    bodies[i] = world->AddCapsule(btScalar(part.radius), btScalar(part.length),
                                  {.mass = btScalar(part.mass), .pose = pose * StandingPose(part)});
  }
  for (const Hinge& hinge : kHinges) AddHinge(world, bodies, hinge, pose);
  for (const Cone& cone : kCones) AddCone(world, bodies, cone, pose);
}

}  // namespace cairn::bench
