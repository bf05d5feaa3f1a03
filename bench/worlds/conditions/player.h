// SPDX-License-Identifier: MIT
#pragma once

#include "scenes/random.h"
#include "scenes/world.h"

namespace cairn::bench {

/// Somebody at play: some eight times a second a body gets another velocity (up to 5 m/s along each
/// axis) or spin (10 rad/s), is moved (0.5 m), is pushed off its centre (5 m/s), or gets up to four
/// times its mass or a quarter of it. What he does depends on nothing that happens in the world, so
/// that it is the same with every solver.
class Player {
 public:
  explicit Player(Random random) : random_(random) {}

  /// Before a step of that length [s].
  void Act(double time_step, World* world);

 private:
  Random random_;
};

}  // namespace cairn::bench
