// SPDX-License-Identifier: MIT
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>

#include "body_table.h"
#include "cairn/bullet/precision.h"
#include "contacts/contact_softness.h"
#include "contacts/friction_directions.h"
#include "contacts/twist_memory.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// What of a contact point its rows are made of.
struct ContactInput {
  btManifoldPoint* point;
  btVector3 arm_a, arm_b;      ///< From the origins of the objects [m].
  btVector3 normal;            ///< Unit length, on B, towards A.
  btVector3 tangents[2];       ///< Directions of friction, of unit length unless it is anisotropic.
  btScalar distance;           ///< With the slop of its softness [m]; negative inside.
  btScalar restitution;        ///< [1]
  Softness softness;           ///< Of the normal.
  btScalar friction[2];        ///< Coefficients along the tangents [1], >= 0.
  btScalar slip;               ///< Bullet's cfm of friction, in units of its step D [1].
  btScalar tangent_speeds[2];  ///< Targets of friction [m/s].
  btScalar normal_impulse;     ///< The start [N s].
  btScalar tangent_impulses[2];
  LeftDirections left;       ///< What has to be left in the point with its impulses.
  int twists;                ///< Rows that resist rolling and spinning, 0 to 3.
  btVector3 twist_axes[3];   ///< Of unit length unless rolling friction is anisotropic.
  btScalar twist_limits[3];  ///< The most they give [N m s], also their coefficients [m], >= 0.
  TwistMemory::Impulses twist_impulses;
};

/// A manifold with those of its points that count.
struct ManifoldInput {
  int body_a, body_b;  ///< Numbers in the BodyTable.
  int points;
  int tangents;  ///< Per point: 1 or 2.
  ContactInput inputs[MANIFOLD_CACHE_SIZE];
};

/// What contacts start from: factors of the impulses of the substep before, in [0, 1].
struct ContactStart {
  btScalar normal = 0, friction = 0;
  TwistMemory* twists = nullptr;  ///< None: what resists rolling starts from nothing.
};

/// Reads a manifold. Writes the directions of friction to its points, as Bullet does, and nothing
/// else. The result has no points if neither body reacts.
/// @param[out] result  only as many inputs are written as it has points
void ReadManifold(btPersistentManifold* manifold, const btContactSolverInfo& info,
                  FrictionBounds bounds, const ContactSoftness& softness, const ContactStart& start,
                  BodyTable* bodies, ManifoldInput* result);

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
