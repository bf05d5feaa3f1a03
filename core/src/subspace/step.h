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
  /// Of the impulses of rows without bounds, the share in [0, 1] that the proximal term draws to 0
  /// instead of to where they are. Redundant joints contradict each other, and each step adds what
  /// that takes divided by proximal_joints: what is not drawn back piles up from frame to frame.
  double leak_joints = 0;
};

struct StepResult {
  bool solved = false;  ///< false: a system could not be factorised, and the state is as it was
  int factorisations = 0;
  /// Largest d |x| of rows without bounds after the step [m/s] or [rad/s]: what an impulse would
  /// change its own row by, and so what floats round at 6e-8 of.
  double joint_speed = 0;
};

/// One subspace minimisation of [1] (contact_problem.h), from a state that sweeps have smoothed:
/// solve for the rows predicted free, fix those that left their bounds, solve again, project.
/// @pre system->Prepare(island)
StepResult TakeStep(const PackedIsland& island, const StepSettings& settings, BodySystem* system,
                    IslandState* state);

}  // namespace cairn
