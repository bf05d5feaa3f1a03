// SPDX-License-Identifier: MIT
#pragma once

#include "reference/pack.h"
#include "step/merit.h"

namespace cairn {

/// @pre the bounds hold
Merit MeasureMerit(const PackedIsland& island, const IslandState& state);

/// With so much of what impulses change velocities by.
IslandMotion MeasureMotion(const PackedIsland& island, const IslandState& state, double share);

/// Multiplies impulses and velocity changes by a factor; 0 leaves nothing of what is not finite.
void ScaleState(double factor, IslandState* state);

}  // namespace cairn
