// SPDX-License-Identifier: MIT
#pragma once

#include "scenes/world.h"

namespace cairn::bench {

/// Adds all joints of a world anew, as btDynamicsWorld::addConstraint() has it by default: the
/// bodies that they connect may collide, and know nothing of them.
void LetConnectedCollide(World* world);

}  // namespace cairn::bench
