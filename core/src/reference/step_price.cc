// SPDX-License-Identifier: MIT
#include "reference/step_price.h"

namespace cairn {
namespace {

// Relaxations of rows in double precision (row_sweep.h) per piece of a step, fitted to timings
// of the tower, wall, pyramid, chain and rubble scenes.
constexpr double kPrepareRow = 1.2;
constexpr double kAnalyseRow = 10;  // where the body graph is new
constexpr double kAssembleRow = 3.3;
constexpr double kFlop = 1 / 33.0;
constexpr double kRefineRow = 3;
constexpr double kSolveEntry = 1 / 7.0;

/// A step that succeeds is worth 100 to 200 sweeps. What costs more than this many does not pay.
constexpr double kMostSweeps = 150;

}  // namespace

BodySystem& SystemOf(IslandMemory* memory) {
  std::shared_ptr<BodySystem>& system = memory->body_system();
  if (system == nullptr) {
    system = std::allocate_shared<BodySystem>(detail::Allocator<BodySystem>());
  }
  return *system;
}

double StepCost(const PackedIsland& island, const Settings& settings, int factorisations,
                const BodySystem& system) {
  const double rows = static_cast<double>(island.rows.size());
  const double factorise = kAssembleRow * rows + kFlop * system.factor_flops();
  const double solve = kRefineRow * rows + kSolveEntry * system.factor_nonzeros();
  return kPrepareRow * rows + factorisations * (factorise + settings.tuning.refinements * solve);
}

double MostStepCost(const PackedIsland& island, const Settings& settings, IslandMemory* memory) {
  const int factorisations = settings.k_sm + (memory->condenses_joints() ? 1 : 0);
  return StepCost(island, settings, factorisations, SystemOf(memory));
}

bool StepPays(const PackedIsland& island, const Settings& settings, const StepBudget& budget,
              IslandMemory* memory) {
  const double rows = static_cast<double>(island.rows.size());
  if (!budget.meter->Fits((kPrepareRow + kAnalyseRow) * rows, budget.sweep_units)) return false;
  BodySystem& system = SystemOf(memory);
  system.Prepare(island);
  const double cost = MostStepCost(island, settings, memory);
  const bool too_dear = cost > kMostSweeps * rows && settings.step_policy != StepPolicy::kAlways;
  if (!too_dear && budget.meter->Fits(cost, budget.sweep_units)) return true;
  memory->Postpone();
  return false;
}

}  // namespace cairn
