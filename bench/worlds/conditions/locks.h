// SPDX-License-Identifier: MIT
#pragma once

#include "scenes/random.h"
#include "scenes/world.h"

namespace cairn::bench {

/// Locks axes of bodies: the same of all, of half of them, or of each its own. As in games seen
/// from the side, in those seen from above with balls that roll and without, of characters, and of
/// what may lean in one plane.
void LockAxes(Random random, World* world);

}  // namespace cairn::bench
