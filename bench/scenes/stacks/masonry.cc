// SPDX-License-Identifier: MIT
#include "scenes/stacks/masonry.h"

namespace cairn::bench {

btTransform Site::At(btScalar x, btScalar y, btScalar z) const {
  return frame * bench::At(x, y, z);
}

Site Site::Turned(int right_angles) const {
  // cos and sin of right angles without rounding: turned walls must be as straight as the others.
  static constexpr btScalar kCos[] = {1, 0, -1, 0}, kSin[] = {0, 1, 0, -1};
  const btScalar c = kCos[right_angles % 4], s = kSin[right_angles % 4];
  const btMatrix3x3 turn(c, 0, s, 0, 1, 0, -s, 0, c);
  return {btTransform(frame.getBasis() * turn, frame.getOrigin())};
}

Site Site::Moved(btScalar x, btScalar y, btScalar z) const { return {At(x, y, z)}; }

btRigidBody* AddBrick(World* world, const Brick& brick, const btTransform& pose, btScalar share) {
  const btVector3 size(brick.length * share - kBrickGap, brick.height, brick.depth);
  return world->AddBox(size / 2,
                       {.mass = brick.mass * share, .pose = pose, .surface = brick.surface});
}

std::vector<btRigidBody*> AddStack(World* world, const Brick& brick, const Site& site, int count) {
  std::vector<btRigidBody*> stack;
  for (int i = 0; i < count; ++i) {
    const btScalar y = (btScalar(i) + btScalar(0.5)) * brick.height;
    stack.push_back(AddBrick(world, brick, site.At(0, y, 0)));
  }
  return stack;
}

std::vector<btRigidBody*> AddWall(World* world, const Brick& brick, const Site& site, int bricks,
                                  int courses) {
  const btScalar half = btScalar(0.5);
  const btScalar left = -half * WallLength(brick, bricks);
  std::vector<btRigidBody*> course;
  for (int row = 0; row < courses; ++row) {
    course.clear();
    const btScalar y = (btScalar(row) + half) * brick.height;
    // Where the next piece begins, in bricks from the left end.
    btScalar begin = 0;
    while (begin < btScalar(bricks)) {
      const bool at_end = begin == 0 || begin + half == btScalar(bricks);
      const btScalar share = row % 2 == 1 && at_end ? half : btScalar(1);
      const btScalar x = left + (begin + share / 2) * brick.length;
      course.push_back(AddBrick(world, brick, site.At(x, y, 0), share));
      begin += share;
    }
  }
  return course;
}

int BricksInWall(int bricks, int courses) { return courses * bricks + courses / 2; }

btScalar WallLength(const Brick& brick, int bricks) { return brick.length * btScalar(bricks); }

}  // namespace cairn::bench
