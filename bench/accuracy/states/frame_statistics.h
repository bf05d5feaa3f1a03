// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "accuracy/shadow.h"

namespace cairn::accuracy {

struct Tail {
  double p50 = 0, p99 = 0, max = 0;
};

/// What a shadow did over many frames; NaN where it never did it.
struct FrameStatistics {
  int frames = 0;
  double stepped = 0;         ///< Share of frames with a step, kept or not.
  double restored = 0;        ///< Share of steps that were undone.
  double factorisations = 0;  ///< Mean.
  Tail cpu_over, wall_over;   ///< Time above the budget; negative: inside it [us].
  Tail wall_over_calm;        ///< The same, of frames that were not interrupted [us].
  int interrupted = 0;
  Tail step_error;  ///< |time / prediction - 1| of steps, of frames that were not interrupted.
};

FrameStatistics StatisticsOf(std::span<const ShadowFrame> frames);

}  // namespace cairn::accuracy
