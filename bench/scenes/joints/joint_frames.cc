// SPDX-License-Identifier: MIT
#include "scenes/joints/joint_frames.h"

#include <memory>

namespace cairn::bench {
namespace {

btTransform FrameAlong(const btVector3& origin, const btVector3& axis, const btVector3& to) {
  return btTransform(shortestArcQuat(axis, to.normalized()), origin);
}

}  // namespace

btTransform Local(const btRigidBody& body, const btTransform& frame) {
  return body.getCenterOfMassTransform().inverse() * frame;
}

btTransform FrameAlongX(const btVector3& origin, const btVector3& to) {
  return FrameAlong(origin, btVector3(1, 0, 0), to);
}

btTransform FrameAlongZ(const btVector3& origin, const btVector3& to) {
  return FrameAlong(origin, btVector3(0, 0, 1), to);
}

void AddPins(World* world, const btVector3& joint, btScalar side, btRigidBody* a, btRigidBody* b) {
  for (const btScalar z : {-side, side}) {
    const btVector3 pin = joint + btVector3(0, 0, z);
    world->AddJoint(std::make_unique<btPoint2PointConstraint>(
                        *a, *b, a->getCenterOfMassTransform().inverse() * pin,
                        b->getCenterOfMassTransform().inverse() * pin),
                    ConnectedBodies::kPassThrough);
  }
}

}  // namespace cairn::bench
