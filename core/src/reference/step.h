// SPDX-License-Identifier: MIT
#pragma once

#include "reference/body_system.h"
#include "reference/pack.h"
#include "step/step_settings.h"

namespace cairn {

/// One subspace minimisation of [1] (contact_problem.h), from a state that sweeps have smoothed:
/// solve for the rows predicted free, fix those that left their bounds, solve again, project.
/// @pre system->Prepare(island)
StepResult TakeStep(const PackedIsland& island, const StepSettings& settings, BodySystem* system,
                    IslandState* state);

}  // namespace cairn
