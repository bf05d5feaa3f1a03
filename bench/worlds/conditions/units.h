// SPDX-License-Identifier: MIT
#pragma once

#include "scenes/world.h"

namespace cairn::bench {

/// Counts all lengths of a world in units of which there are so many in a metre, as games have it
/// that count in centimetres (100): shapes with their margins, places, speeds, gravity, joints with
/// their forces, springs and motors, and all lengths and speeds among Bullet's settings. What
/// happens is the same but for rounding, where neither Bullet nor a solver thinks in metres.
/// Numbers without a length stay: masses, times, angles, frictions but those of rolling.
/// @pre no step was made, and nobody else has bodies of this world
void ChangeUnits(double per_metre, World* world);

}  // namespace cairn::bench
