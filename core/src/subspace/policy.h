// SPDX-License-Identifier: MIT
#pragma once

#include "budget.h"
#include "cairn/settings.h"
#include "subspace/body_system.h"
#include "subspace/step.h"

namespace cairn {

/// What a step has to fit in.
struct StepBudget {
  BudgetMeter* meter;
  double gain;  ///< Work units that sweeps do in the time that one took when steps were priced.
  double sweep_units;  ///< Sweeps to be made after the step.
};

/// What the solver remembers of an island from frame to frame: the analysed system, the proximal
/// term that worked, and whether steps pay.
class IslandMemory {
 public:
  StepSettings Step(const Settings& settings) const;

  /// Whether to ask StepPays(): no step failed here of late, and the budget is not all but spent.
  bool Due(double rows, const Settings& settings, const StepBudget& budget);
  /// Whether a step should be tried now: it costs less than a step can gain, and together with the
  /// sweeps after it is predicted to fit the budget. On true, system() is prepared for the island.
  bool StepPays(const PackedIsland& island, const Settings& settings, const StepBudget& budget);

  /// What a step costs that made so many factorisations, in relaxations of rows in double
  /// precision.
  /// @pre StepPays()
  double Cost(const PackedIsland& island, const Settings& settings, int factorisations) const;

  void Accepted();
  void Restored();

  BodySystem& system() { return system_; }

 private:
  BodySystem system_;
  double softening_ = 1;  ///< factor on Settings::proximal, >= 1
  int strikes_ = 0;       ///< rejections in a row
  int pause_ = 0;         ///< opportunities still to be passed over
};

}  // namespace cairn
