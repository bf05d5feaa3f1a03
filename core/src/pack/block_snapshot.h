// SPDX-License-Identifier: MIT
#pragma once

#include "cairn/detail/memory.h"
#include "pack/block_pack.h"
#include "plan/plan.h"

namespace cairn {

/// A copy of the state of some islands, each where it is in the blocks.
class BlockSnapshot {
 public:
  /// Makes room for all of it.
  void Reserve(const BlockData& blocks);
  void Take(const Plan& plan, int island, const BlockData& blocks);
  void Restore(const Plan& plan, int island, BlockData* blocks) const;

 private:
  Array<simd::Line> x_;
  Array<simd::BodyLane> bodies_;
};

}  // namespace cairn
