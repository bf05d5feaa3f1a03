// SPDX-License-Identifier: MIT
#include "support/sample_plan.h"

#include <algorithm>

namespace cairn::cli {

SamplePlan::SamplePlan(int samples, int first, int frames)
    : samples_(std::min(samples, (frames - first) / 4)), first_(first), frames_(frames) {}

int SamplePlan::FrameOf(int sample) const {
  // In the middle of each of samples_ equal parts, which are 4 frames or longer.
  return first_ + static_cast<int>((2LL * sample + 1) * (frames_ - first_) / (2LL * samples_));
}

bool SamplePlan::IsSample(int frame) const {
  for (int i = 0; i < samples_; ++i) {
    if (FrameOf(i) == frame) return true;
  }
  return false;
}

}  // namespace cairn::cli
