// SPDX-License-Identifier: MIT
#pragma once

#include <btBulletDynamicsCommon.h>

#include "scenes/world.h"

namespace cairn::bench {

/// `frame` of the world as the body sees it now.
btTransform Local(const btRigidBody& body, const btTransform& frame);

/// Frames whose x or z points along `to`, which need not have unit length: x is the axis of cones
/// and the first one of 6-dof joints, z that of hinges.
btTransform FrameAlongX(const btVector3& origin, const btVector3& to);
btTransform FrameAlongZ(const btVector3& origin, const btVector3& to);

/// Two pins that hold @p a and @p b together, `side` [m] to either side of a joint along z.
void AddPins(World* world, const btVector3& joint, btScalar side, btRigidBody* a, btRigidBody* b);

}  // namespace cairn::bench
