// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "cairn/detail/memory.h"
#include "cycle/cycle_frame.h"

namespace cairn {

/// Targets of joints while steps begin. Errors of position that sweeps left open for long, and at
/// rest, the first step would take back at once, with a jerk; see StepOdds::share(). Loads are held
/// all the same, and motors run as fast as they are asked to.
class EasedTargets {
 public:
  /// Rows without bounds of the joints of an island take back this share of their errors.
  void Ease(const CycleFrame& frame, int island, double share);
  bool any() const { return !eased_.empty(); }
  /// All are as they were.
  void GiveBack(BlockData* blocks);

 private:
  struct Eased {
    std::uint32_t line;
    int lane;
    float target;
  };
  void EaseLane(const CycleFrame& frame, int block, int lane, double share);

  Array<Eased> eased_;
};

}  // namespace cairn
