// SPDX-License-Identifier: MIT
#pragma once

#include "cairn/detail/memory.h"
#include "cairn/report.h"
#include "cycle/block_steps.h"
#include "cycle/cycle_frame.h"
#include "cycle/cycle_islands.h"
#include "cycle/cycle_sweeps.h"
#include "cycle/step_planner.h"
#include "cycle/step_trials.h"
#include "pack/block_snapshot.h"
#include "step/merit.h"
#include "sweep/block_sweep.h"
#include "sweep/nncg.h"

namespace cairn {

/// The algorithm on blocks, in rounds of k_gs sweeps that all islands make together:
///
///   repeat   k_gs sweeps
///            subspace steps where they pay, and k_gs sweeps, or k_gs sweeps alone on the islands
///            that end better so
///   until the residual, the sweep limit or the budget says so
///
/// An island that is done keeps the state it had then, even where the lanes that it shares go on:
/// without a budget, no island sees the others. Nothing is allocated in a frame that is no larger
/// than those before it, steps apart.
class BlockCycle {
 public:
  /// Runs to the end. @p report: gets the islands.
  void Run(const CycleFrame& frame, Report* report);

 private:
  void Begin();
  /// Scales impulses of the start that sweeps would overshoot from; see BlockSteps::Overshoots().
  void SoftenStart();
  /// For the SoftenStart() of the next Solve().
  void RememberEnds();
  /// Scales impulses of the start that are worse than none where they are judged after so many
  /// sweeps.
  void GuardStart(int sweeps);
  /// Likewise impulses in the end.
  void GuardResult();
  /// See SettlesFriction().
  void SettleFriction();
  bool Settles(int island) const;
  void Round();
  /// Takes down what the first sweep saw.
  void MarkStart();
  void JudgeIslands(bool seen);
  /// Stops islands whose sweeps that are made in any case are done.
  void StopLate();
  void JudgeNear();
  /// Keeps the state of islands that have stopped, where their lanes go on.
  void CloseGroups();
  /// Residuals of the islands of the groups that are chosen, into after_.
  void ReadErrors();
  void KeepBest();
  /// The best states, and their residuals.
  void Finish();
  void FillReport(Report* report) const;

  const CycleFrame* frame_ = nullptr;
  BlockSweeps* sweeps_ = nullptr;
  CycleIslands islands_;
  BlockSteps steps_;
  StepPlanner planner_;
  StepTrials trials_;
  Nncg nncg_;
  CycleSweeps cycle_sweeps_;

  GroupChoice chosen_;
  Array<Residual> after_;  ///< by island: of the present state
  Array<Residual> bests_;  ///< by island: of best_; the energy is infinite if there is none
  IslandMerits merits_;
  Array<float> scales_;  ///< by island: what a guard multiplies impulses by
  BlockSnapshot done_, best_;
  int rounds_ = 0;
  bool started_ = false;  ///< a whole sweep was made
};

}  // namespace cairn
