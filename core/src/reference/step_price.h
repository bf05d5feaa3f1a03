// SPDX-License-Identifier: MIT
#pragma once

#include "cairn/settings.h"
#include "reference/body_system.h"
#include "reference/pack.h"
#include "runtime/budget.h"
#include "step/island_memory.h"

namespace cairn {

/// What a step has to fit in.
struct StepBudget {
  BudgetMeter* meter;
  double sweep_units;  ///< Sweeps to be made after the step.
};

/// The analysed system of an island, kept in its memory.
BodySystem& SystemOf(IslandMemory* memory);

/// Whether a step should be tried now: it costs less than a step can gain, and together with the
/// sweeps after it is predicted to fit the budget. On true, SystemOf() is prepared for the island.
bool StepPays(const PackedIsland& island, const Settings& settings, const StepBudget& budget,
              IslandMemory* memory);

/// What the next step costs at most. @pre StepPays()
double MostStepCost(const PackedIsland& island, const Settings& settings, IslandMemory* memory);

/// What a step costs that made so many factorisations, in relaxations of rows in double precision.
/// @pre StepPays()
double StepCost(const PackedIsland& island, const Settings& settings, int factorisations,
                const BodySystem& system);

}  // namespace cairn
