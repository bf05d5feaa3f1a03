// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "cairn/contact_problem.h"
#include "cairn/settings.h"
#include "pack/block_frame.h"
#include "runtime/budget.h"
#include "runtime/crew.h"
#include "step/island_memories.h"
#include "step/step_settings.h"

namespace cairn {

/// What a cycle works on in one Solve(). All of it outlives the cycle.
struct CycleFrame {
  const ContactProblem& problem;
  const Settings& settings;
  BlockFrame* blocks;  ///< A frame that has begun.
  IslandMemories* memories;
  BudgetMeter* meter;
  Crew* crew;

  const Plan& plan() const { return blocks->plan(); }
  BlockData* data() const { return &blocks->blocks(); }
  int islands() const { return static_cast<int>(plan().islands().size()); }

  /// Steps may be taken at all.
  bool asks_for_steps() const { return settings.method == Method::kPgsSm && settings.k_sm > 0; }
  /// A budget is shared by steps and sweeps: what both gain is looked at.
  bool watches_gains() const {
    return asks_for_steps() && meter->limited() && settings.step_policy != StepPolicy::kAlways;
  }
  /// Steps are weighed against the sweeps in their place, see StepPolicy::kWeighed.
  bool weighs_steps() const {
    return asks_for_steps() && !meter->limited() && settings.step_policy == StepPolicy::kWeighed;
  }
  /// Settings::k_gs. Where steps are weighed, as many fewer as leave a step of few sweeps those
  /// that smooth it: with 5, 2 of 4, 2 of 5, 3 of 6, 4 of 7.
  int sweeps_of_round() const {
    const int most = settings.max_sweeps;
    if (!weighs_steps()) return settings.k_gs;
    return std::clamp(std::max(most / 2, most - kLeastSweepsAfterStep), 1, settings.k_gs);
  }
  /// What steps and sweeps gain is learnt.
  bool learns() const { return watches_gains() || weighs_steps(); }
  bool accelerates() const {
    return settings.method == Method::kPgsSm && settings.acceleration == Acceleration::kNncg;
  }
};

}  // namespace cairn
