// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

namespace cairn::cli {

/// Which frames from `first` on are sampled: `samples` of them, spread evenly; at most one in four,
/// so that enough frames are left to be timed.
class SamplePlan {
 public:
  SamplePlan(int samples, int first, int frames)
      : samples_(std::min(samples, (frames - first) / 4)), first_(first), frames_(frames) {}

  int samples() const { return samples_; }
  bool IsSample(int frame) const {
    for (int i = 0; i < samples_; ++i) {
      if (FrameOf(i) == frame) return true;
    }
    return false;
  }
  /// The frame before a sample, in which the sampled solvers warm up.
  bool IsWarmUp(int frame) const { return IsSample(frame + 1); }

 private:
  /// In the middle of each of samples_ equal parts, which are 4 frames or longer.
  int FrameOf(int sample) const {
    return first_ + static_cast<int>((2LL * sample + 1) * (frames_ - first_) / (2LL * samples_));
  }

  int samples_, first_, frames_;
};

}  // namespace cairn::cli
