// SPDX-License-Identifier: MIT
#pragma once

#include "budget.h"
#include "cairn/settings.h"
#include "subspace/body_system.h"
#include "subspace/step.h"

namespace cairn {

/// What the solver remembers of an island from frame to frame: the analysed system, the proximal
/// term that worked, and whether steps pay.
class IslandMemory {
 public:
  StepSettings Step(const Settings& settings) const;

  /// Whether a step should be tried now: none failed here of late, it costs less than a step can
  /// gain, and together with @p sweep_units of sweeps it is predicted to fit the budget.
  /// On true, system() is prepared for the island.
  bool StepPays(const PackedIsland& island, const Settings& settings, const BudgetMeter& meter,
                double sweep_units);

  /// Work units of a step that made so many factorisations. @pre StepPays()
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
