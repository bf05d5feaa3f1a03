// SPDX-License-Identifier: MIT
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <span>
#include <vector>

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

/// Some of what is in a group.
struct PartOfGroup {
  std::vector<btCollisionObject*> bodies;
  std::vector<btPersistentManifold*> manifolds;
  std::vector<btTypedConstraint*> joints;

  /// Good until it changes.
  Group WithUnits(double units_per_metre) const {
    return {bodies, manifolds, joints, units_per_metre};
  }
  void Clear() {
    bodies.clear();
    manifolds.clear();
    joints.clear();
  }
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
