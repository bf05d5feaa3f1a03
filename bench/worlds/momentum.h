// SPDX-License-Identifier: MIT
#pragma once

#include "scenes/world.h"

namespace cairn::bench {

/// How far the momentum of a world without anything static has strayed from what gravity makes of
/// it. In double precision; angular momentum about the common centre of mass.
class MomentumWatch {
 public:
  explicit MomentumWatch(const World& world);

  /// To be called after each step. @param time  since the start [s]
  void Look(const World& world, double time);

  /// Largest so far, relative to the largest sum of the sizes of all momenta.
  double linear() const { return linear_ / linear_size_; }
  double angular() const { return angular_ / angular_size_; }

 private:
  double linear_ = 0, angular_ = 0, linear_size_ = 1e-30, angular_size_ = 1e-30;
  double start_[6];
};

}  // namespace cairn::bench
