// SPDX-License-Identifier: MIT
#include "worlds/conditions/collisions.h"

namespace cairn::bench {

void LetConnectedCollide(World* world) {
  for (btTypedConstraint* const joint : world->joints()) world->bullet()->removeConstraint(joint);
  for (btTypedConstraint* const joint : world->joints()) world->bullet()->addConstraint(joint);
}

}  // namespace cairn::bench
