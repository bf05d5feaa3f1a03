// SPDX-License-Identifier: MIT
#include "scenes/joints/joint_frames.h"

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

}  // namespace cairn::bench
