// SPDX-License-Identifier: MIT
#pragma once

#include "cairn/report.h"
#include "cairn/settings.h"
#include "reference/pack.h"
#include "runtime/budget.h"
#include "step/island_memory.h"

namespace cairn {

/// The algorithm on one island, a round of k_gs sweeps at a time so that many islands can share a
/// budget:
///
///   repeat   k_gs sweeps
///            subspace step and k_gs sweeps, or k_gs sweeps alone if those end better
///   until the residual, the sweep limit or the budget says so
class IslandCycle {
 public:
  /// Island, settings and memory must outlive the cycle.
  IslandCycle(const PackedIsland& island, IslandState start, const Settings& settings,
              IslandMemory* memory);

  bool done() const { return at_.stop != StopReason::kNotStarted; }
  /// k_gs sweeps, or a step and the sweeps after it.
  void Advance(BudgetMeter* meter);

  const IslandState& state() const { return at_.state; }
  /// @pre done()
  IslandReport Finish();

 private:
  /// How far the iteration has come.
  struct Point {
    IslandState state;
    int sweeps = 0;
    StopReason stop = StopReason::kNotStarted;
  };

  /// A step is wanted at all, and may be followed by enough sweeps.
  bool StepsLeft() const;
  /// It is worth its price here, and inside the budget.
  bool StepPays(BudgetMeter* meter);
  bool StepFits(BudgetMeter* meter) const;
  double UnitsAfterStep() const;
  void StepRound(BudgetMeter* meter);
  /// After a step: keeps it, or the same number of sweeps from @p before alone.
  /// @p sound: it may be kept
  bool KeepBetter(Point before, bool sound, const Residual& with_step, BudgetMeter* meter);
  /// Scales impulses that are worse than none; whether they were.
  bool GuardState();
  /// See SettlesFriction().
  void SettleFriction();

  /// Up to @p count sweeps; stops early when the budget is spent or nothing moves.
  void Sweeps(int count, BudgetMeter* meter);
  bool SweepOnce(BudgetMeter* meter);
  int SweepsOfRound() const;
  /// The budget is spent, and the sweeps that are made in any case are done.
  bool Spent(const BudgetMeter& meter) const;
  Residual MeasureNow(BudgetMeter* meter) const;
  void Stop(StopReason reason) { at_.stop = reason; }
  double units_per_sweep() const { return static_cast<double>(island_.rows.size()); }

  const PackedIsland& island_;
  const Settings& settings_;
  IslandMemory* memory_;
  Point at_;
  Residual residual_;  ///< before a step
  bool step_next_ = false;
  bool guards_ = false;
  bool joints_ = false;  ///< some row has no bounds
  IslandReport report_;
};

}  // namespace cairn
