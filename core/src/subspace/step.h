// SPDX-License-Identifier: MIT
#pragma once

#include "pack.h"
#include "subspace/body_system.h"

namespace cairn {

struct StepSettings {
  double proximal;         ///< Settings::proximal, as adapted to the island
  double proximal_joints;  ///< Settings::proximal_joints
  int factorisations;      ///< at most, >= 1
  int refinements;         ///< solves with each factor, >= 1
};

struct StepResult {
  bool solved = false;  ///< false: a system could not be factorised, and the state is as it was
  int factorisations = 0;
};

/// One subspace minimisation of [1] (contact_problem.h), from a state that sweeps have smoothed:
/// solve for the rows predicted free, fix those that left their bounds, solve again, project.
/// @pre system->Prepare(island)
StepResult TakeStep(const PackedIsland& island, const StepSettings& settings, BodySystem* system,
                    IslandState* state);

}  // namespace cairn
