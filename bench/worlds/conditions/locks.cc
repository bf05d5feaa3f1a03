// SPDX-License-Identifier: MIT
#include "worlds/conditions/locks.h"

#include <algorithm>

namespace cairn::bench {
namespace {

/// What a body may not do.
struct Locks {
  btVector3 linear, angular;
};

Locks DrawLocks(Random* random) {
  static const Locks kLocks[] = {{{1, 1, 0}, {0, 0, 1}},
                                 {{1, 0, 1}, {0, 1, 0}},
                                 {{1, 0, 1}, {1, 1, 1}},
                                 {{1, 1, 1}, {0, 0, 0}},
                                 {{1, 1, 1}, {0, 0, 1}}};
  return kLocks[std::min(4, static_cast<int>(random->Within(0, 5)))];
}

}  // namespace

void LockAxes(Random random, World* world) {
  const double draw = random.Within(0, 1);
  Locks locks = DrawLocks(&random);
  for (btRigidBody* body : world->dynamic_bodies()) {
    if (draw > 0.8) locks = DrawLocks(&random);
    if (draw > 0.6 && random.Within(0, 1) < 0.5) continue;
    body->setLinearFactor(locks.linear);
    body->setAngularFactor(locks.angular);
  }
}

}  // namespace cairn::bench
