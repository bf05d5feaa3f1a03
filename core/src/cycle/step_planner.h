// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "cairn/detail/memory.h"
#include "cycle/block_steps.h"
#include "cycle/cycle_frame.h"
#include "cycle/cycle_islands.h"

namespace cairn {

/// Which islands take a step between two rounds of sweeps, and with how many factorisations: those
/// where it fits the budget, or the effort, and is thought to do more than the sweeps in its place.
/// What refused it is in IslandReport::no_step.
class StepPlanner {
 public:
  /// All of it outlives the frame.
  void Begin(const CycleFrame& frame, BlockSteps* steps, CycleIslands* islands);
  /// Islands that take a step now; those of a group follow each other.
  std::span<const int> PlanRound();
  /// How many sweeps an island makes without a step, Settings::max_sweeps at least.
  int SweepsInPlace(int island) const;
  /// The same as far as steps were taken there.
  int MostSweeps(int island) const;
  /// Tells the odds what sweeps gained, after the last one.
  void Learn();

 private:
  /// Work of the steps that are to be taken now, and of the sweeps that they need.
  struct Planned {
    double steps = 0, sweeps = 0;
  };
  /// Those of a group that may be stepped on go to the end of planned_.
  void AddCandidates(int group);
  /// Adds a step on islands of a group; NoStep::kEnded if it may be taken, else why not.
  NoStep PlanStep(int group, std::span<const int> islands, Planned* planned);
  /// Likewise, whether their graph is known or was analysed for it. @p planned: with the sweeps
  /// after this one
  NoStep PlanGraph(int group, std::span<const int> islands, const Planned& planned);
  /// With a budget: whether it does more than the sweeps in its place; see StepOdds. @p planned:
  /// work of steps before it
  bool Pays(int group, std::span<const int> islands, double planned, double price);
  /// Without a budget: a step may be taken, and with how many factorisations.
  NoStep Weigh(int group, int island);
  /// Weighs planned_ from @p first on, in a group, once more.
  void KeepWorthwhile(int group, size_t first);

  const CycleFrame* frame_ = nullptr;
  BlockSteps* steps_ = nullptr;
  CycleIslands* islands_ = nullptr;
  Array<int> planned_;
};

}  // namespace cairn
