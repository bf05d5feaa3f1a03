// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "scenes/world.h"

namespace cairn::bench {

/// Boxes and bricks next to each other leave a gap, so that nothing overlaps when it is built; on
/// top of each other they touch.
inline constexpr btScalar kBrickGap = btScalar(0.001);  // [m]

/// A kind of brick: length along the wall, height, depth [m], and mass [kg].
struct Brick {
  btScalar length, height, depth, mass;
  Surface surface = {};
};

/// The local frame of something that is built: x along it, y up, origin on the ground.
struct Site {
  btTransform frame = btTransform::getIdentity();

  /// A pose in the world, of a point given in the local frame [m].
  btTransform At(btScalar x, btScalar y, btScalar z) const;
  /// The same place and height, turned about y by a number of right angles, exactly.
  Site Turned(int right_angles) const;
  /// Moved along its own axes [m].
  Site Moved(btScalar x, btScalar y, btScalar z) const;
};

/// A brick, or the part of one that is `share` of its length, with its centre at a point of the
/// site.
btRigidBody* AddBrick(World* world, const Brick& brick, const btTransform& pose,
                      btScalar share = 1);

/// Bricks on top of each other; the lowest stands on the site's origin. Returned bottom up.
std::vector<btRigidBody*> AddStack(World* world, const Brick& brick, const Site& site, int count);

/// A wall in running bond: courses of `bricks` whole bricks, every second one of `bricks` - 1 whole
/// ones between two halves. Centred on the site's origin. Returns the top course.
std::vector<btRigidBody*> AddWall(World* world, const Brick& brick, const Site& site, int bricks,
                                  int courses);

/// Bricks in such a wall.
int BricksInWall(int bricks, int courses);

/// Length of such a wall [m].
btScalar WallLength(const Brick& brick, int bricks);

}  // namespace cairn::bench
