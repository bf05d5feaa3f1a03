// SPDX-License-Identifier: MIT
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <span>

#include "cairn/bullet/precision.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

using JointSpan = std::span<btTypedConstraint* const>;

/// What Bullet hands to a solver.
struct Group {
  std::span<btCollisionObject* const> bodies;
  std::span<btPersistentManifold* const> manifolds;
  JointSpan joints;
  double units_per_metre = 1;  ///< See Tuning.
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
