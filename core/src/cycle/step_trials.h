// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "cairn/detail/memory.h"
#include "cairn/report.h"
#include "cycle/block_steps.h"
#include "cycle/cycle_frame.h"
#include "cycle/cycle_islands.h"
#include "cycle/cycle_sweeps.h"
#include "cycle/eased_targets.h"
#include "cycle/step_planner.h"
#include "pack/block_snapshot.h"
#include "step/merit.h"
#include "sweep/block_sweep.h"
#include "sweep/nncg.h"

namespace cairn {

/// Takes steps, and after the sweeps that follow them keeps those that are better than as many
/// sweeps alone, do no harm, and do not stand alone among frames of sweeps.
class StepTrials {
 public:
  /// What it works with; outlives the frame.
  struct Parts {
    BlockSteps* steps;
    StepPlanner* planner;
    CycleIslands* islands;
    BlockSweeps* sweeps;
    CycleSweeps* cycle_sweeps;
    Nncg* nncg;
  };
  void Begin(const CycleFrame& frame, const Parts& parts);

  /// Takes a step on each of these islands; those of a group follow each other.
  void Take(std::span<const int> islands);
  /// Steps were taken and are not judged yet.
  bool pending() const { return !stepped_.empty(); }
  /// Judges them, so many sweeps later, and undoes those that are not kept.
  void Judge(int sweeps);

 private:
  /// kSeen: it would be kept, were it not Manner::kLooks.
  enum class Verdict : char { kKept, kBetterAlone, kHarmful, kSeen };
  /// What a step takes back of the errors of joints, see StepOdds::share() and only_looks().
  enum class Manner : char { kWhole, kEased, kLooks };

  /// Finds manners, and eases targets where steps begin.
  void Ease();
  /// Targets are whole again, and so are residuals.
  void EndEasing();
  void TakeOfGroup(int group, std::span<const int> islands);
  /// Residuals of the islands of the groups that are chosen.
  void Measure(Array<Residual>* residuals);
  void Choose(std::span<const int> islands);
  /// Marks steps that put in energy, threw, flung or squeezed bodies, or left impulses that floats
  /// cannot hold.
  void FindHarm();
  /// See IsFlung(): by impulses, not by a hook or a platform that moves.
  bool IsFlung(int island, double error) const;
  /// It is under strain, and its step made nothing faster: see IsFaster().
  bool Catches(int island) const;
  /// It has joints, and had no step of late.
  bool Begins(int island);
  /// A step did so much that sweeps alone need not be tried.
  bool IsSure(int island);
  /// The sweeps without its step brought an island closer to its solution than those with it.
  bool IsBetterAlone(int island);
  /// Learns from a trial. Where steps did not pay before it, and do not after it, its step is not
  /// kept: one among frames of sweeps pushes what rests.
  void LearnGains(int island);
  /// By how much a step and its sweeps brought phi down, see Merit, and so many sweeps alone [J].
  double GainOfStep(int island) const;
  double GainAlone(int island) const;
  /// Makes as many sweeps from before the steps on the islands that are chosen, and keeps the
  /// better state of each. They are plain: accelerated ones come closer in each frame, but towers
  /// lean by what they leave.
  void TryAlone(int sweeps);
  /// Without a budget, and where sweeps are accelerated, what is undone leaves no trace.
  bool GoesOnAlone() const;
  /// Makes the sweeps that would have been made without the steps that are not kept.
  void GoOnAlone(int sweeps);
  /// Groups that are chosen were swept so many times less.
  void RewindSweeps(int sweeps);
  void KeepAsAfterSteps(int island);
  /// There is no time for that: what is no better than before the step is undone.
  void CompareWithBefore();
  /// What became of a step, for all that learn from it.
  void Note(int island, int sweeps);
  /// Sets time aside to judge the steps on the islands that are chosen.
  void SetJudgingAside();

  const CycleFrame* frame_ = nullptr;
  Parts parts_ = {};
  GroupChoice chosen_;
  Array<int> stepped_;
  Array<Verdict> verdicts_;                                      ///< by island
  Array<Manner> manners_;                                        ///< likewise
  Array<Residual> seen_with_step_, before_, with_step_, alone_;  ///< by island
  IslandMerits merits_before_, merits_with_step_, merits_alone_;
  BlockSnapshot before_steps_, after_steps_;
  EasedTargets eased_;
};

}  // namespace cairn
