// SPDX-License-Identifier: MIT
#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "body_table.h"
#include "cairn/bullet/precision.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// The 12 entries of J of a row between two bodies.
struct Axes {
  btVector3 linear_a, angular_a, linear_b, angular_b;
};

/// What a unit impulse along one half of a row changes of the velocities of that body.
struct Response {
  btVector3 linear{0, 0, 0}, angular{0, 0, 0};
};

/// As Bullet has it, with the factors of the body. @p rigid may be none, or may not react.
inline Response ResponseOf(const btRigidBody* rigid, const btVector3& linear,
                           const btVector3& angular) {
  if (rigid == nullptr || !Reacts(*rigid)) return {};
  return {linear * rigid->getInvMass() * rigid->getLinearFactor(),
          rigid->getInvInertiaTensorWorld() * angular * rigid->getAngularFactor()};
}

/// The share of one body in the diagonal that Bullet gives contacts and friction: without its
/// linear factor, and as if the direction had unit length [1/kg].
inline btScalar ContactDiagonal(const btRigidBody* rigid, const btVector3& angular) {
  if (rigid == nullptr || !Reacts(*rigid)) return 0;
  return rigid->getInvMass() +
         (rigid->getInvInertiaTensorWorld() * angular * rigid->getAngularFactor()).dot(angular);
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
