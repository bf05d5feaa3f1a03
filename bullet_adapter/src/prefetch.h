// SPDX-License-Identifier: MIT
#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "cairn/bullet/precision.h"
#include "cairn/detail/prefetch.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// What is common to joints of all types, and about as much as most of them are [bytes].
inline constexpr int kHeadOfJoint = sizeof(btTypedConstraint), kMostOfJoint = 768;

/// Asks for a joint before it is needed: joints lie all over the memory of the game.
inline void PrefetchJoint(const btTypedConstraint& joint, int bytes) { Prefetch(&joint, bytes); }

/// And for its bodies, once it is there: where they are, how they turn and move, their masses.
inline void PrefetchBodies(const btTypedConstraint& joint) {
  for (const btRigidBody* body : {&joint.getRigidBodyA(), &joint.getRigidBodyB()}) {
    Prefetch(&body->getWorldTransform(), sizeof(btTransform));
    Prefetch(&body->getInvInertiaTensorWorld(), sizeof(btMatrix3x3) + 3 * sizeof(btVector3));
  }
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
