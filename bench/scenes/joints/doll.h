// SPDX-License-Identifier: MIT
#pragma once

#include "scenes/world.h"

namespace cairn::bench {

/// A ragdoll: capsules, hinges at its back, elbows and knees, cones at its neck, shoulders and
/// hips. In its pose it stands at x = z = 0 with its feet at y = 0 and its arms spread along x.
void AddDoll(World* world, const btTransform& pose);

int DollParts();
inline int DollJoints() { return DollParts() - 1; }
double DollMass();  ///< [kg]
/// The height of the highest centre of mass of a doll in that pose [m].
double DollTop(const btTransform& pose);

/// The pose of a doll that lies on its back around a point, turned about y by a number of right
/// angles and raised by `tilt` [rad].
btTransform LyingDoll(const btVector3& centre, int right_angles, btScalar tilt);

}  // namespace cairn::bench
