// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "cycle/cycle_frame.h"
#include "cycle/cycle_islands.h"
#include "sweep/block_sweep.h"
#include "sweep/nncg.h"

namespace cairn {

/// Sweeps of a cycle, accelerated where its settings say so, and what they see of its islands.
class CycleSweeps {
 public:
  /// What islands whose step is not judged yet hold.
  enum class Steps {
    kIn,      ///< What steps leave behind is rough, and wants to be smoothed, not carried on.
    kUndone,  ///< The state before them, with its directions.
  };

  /// All of it outlives the frame.
  void Begin(const CycleFrame& frame, BlockSweeps* sweeps, CycleIslands* islands, Nncg* nncg);

  /// Makes so many sweeps over active groups, unless the budget ends before: false. The last one is
  /// seen.
  bool Sweep(int count, std::span<GroupSweeps> groups, Steps steps);

 private:
  /// Each group all of them before the next: it stays in the cache.
  void SweepGroupByGroup(int count, std::span<GroupSweeps> groups, Steps steps);
  /// Some island is not stepped: its state may move on.
  bool AnyMoves(Steps steps) const;
  /// Moves the state on for one sweep, where that still fits.
  bool MoveOn(std::span<const GroupSweeps> groups, Steps steps);
  /// From what the last sweep of an active group saw.
  void LearnDirections(int group, int sweeps, Steps steps);

  const CycleFrame* frame_ = nullptr;
  BlockSweeps* sweeps_ = nullptr;
  CycleIslands* islands_ = nullptr;
  Nncg* nncg_ = nullptr;
};

}  // namespace cairn
