// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "scenes/random.h"
#include "scenes/world.h"

namespace cairn::bench {

/// Makes kinematic bodies of those that are static, and moves them to and fro: in half of the
/// worlds all together, like a ship that rolls by 0.3 rad and goes 0.5 m along each axis, in the
/// others each by itself, 0.2 m. Ropes and nets between bodies of the latter kind may be asked for
/// more than their length.
class MovingGround {
 public:
  MovingGround(Random random, World* world);

  /// Where they are at a time [s] >= 0; at 0 where they were.
  void MoveTo(double time);

 private:
  struct Mover {
    btRigidBody* body;
    btTransform pose;  ///< at the start
    btVector3 reach;   ///< [m]
    btScalar turn;     ///< about the origin, at `reach` [rad]
    double pace;       ///< [rad/s]
  };
  std::vector<Mover> movers_;
};

}  // namespace cairn::bench
