// SPDX-License-Identifier: MIT
#pragma once

#include "worlds/draft.h"

namespace cairn::bench {

/// Bricks of 4 x 2 x 2 half heights in a running bond, across x, its middle at the origin.
struct WallSize {
  int columns, courses;
  btScalar half, mass;  ///< Half the height of a brick [m], of a brick [kg].
};
void AddWall(Draft* draft, const WallSize& size);

/// Boxes one on another from `foot` up; the mass of box i is mass growth^i [kg].
struct StackSize {
  int boxes;
  btScalar half, mass, growth;
};
std::vector<btRigidBody*> AddStack(Draft* draft, const StackSize& size, const btVector3& foot);

}  // namespace cairn::bench
