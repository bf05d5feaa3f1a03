// SPDX-License-Identifier: MIT
#pragma once

namespace cairn::cli {

/// Which frames from `first` on are sampled: `samples` of them, spread evenly; at most one in four,
/// so that enough frames are left to be timed.
class SamplePlan {
 public:
  SamplePlan(int samples, int first, int frames);

  int samples() const { return samples_; }
  bool IsSample(int frame) const;
  /// The frame before a sample, in which the sampled solvers warm up.
  bool IsWarmUp(int frame) const { return IsSample(frame + 1); }

 private:
  int FrameOf(int sample) const;

  int samples_, first_, frames_;
};

}  // namespace cairn::cli
