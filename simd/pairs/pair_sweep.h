// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "simd/pairs/pair_block.h"
#include "simd/target.h"

namespace cairn::simd {

/// Lanes to work on, in this order. What is worked on at the same time shares no body, except by
/// copies.
struct PairWork {
  const PairBlock* blocks = nullptr;
  const LaneRun* runs = nullptr;  ///< Of those blocks: what the passes that move something go over.
  int run_count = 0;
  int first_block = 0, block_count = 0;  ///< What measure() looks at: the blocks of those runs.
  const Line* data = nullptr;            ///< Constant part of the rows.
  Line* x = nullptr;                     ///< Impulses.
  BodyLane* bodies = nullptr;            ///< By slot.
  /// Slots from first_copy on are of these. They hold zeros but during a pass over their run.
  const BodyCopy* copies = nullptr;
  int first_copy = std::numeric_limits<int>::max();
  /// Of rows of blocks with copies: d as lanes see it, over that of whole bodies, which errors are
  /// measured by.
  const Line* d_ratios = nullptr;
  /// By block. Read by nothing, written by the passes that measure.
  BlockError* errors = nullptr;
  int sweep = 0;             ///< Sweeps of the Solve() made before this one.
  bool hold_lifted = false;  ///< LiftedFriction::kHold
};

/// What can be done with them. Same bits on every target.
struct PairKernels {
  using Kernel = void (*)(const PairWork& work);

  /// Fills in the couplings of a block whose other lines are there. @p lines: its first
  void (*couple)(const PairBlock& block, Line* lines);

  /// u += G' x, to start from given impulses.
  Kernel start;
  /// Relaxes every row alone, one after the other, and brings it back inside its bounds:
  ///   x := clamp(x - step w),   w = G u + compliance x - target,   u += G' (change of x).
  Kernel sweep;
  /// The same, and errors from what every row was moved by. They are natural residuals of states on
  /// the way through the sweep, not of the one it ends with.
  Kernel measured_sweep;
  /// A sweep over the rows that have a parent, and no others.
  Kernel friction;
  /// Natural residuals of the present state. Changes nothing else.
  Kernel measure;
};

/// Kernels for one target. @pre the CPU supports it
const PairKernels& PairKernelsFor(Target target);

}  // namespace cairn::simd
