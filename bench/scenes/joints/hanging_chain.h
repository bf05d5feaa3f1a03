// SPDX-License-Identifier: MIT
#pragma once

#include "scenes/world.h"

namespace cairn::bench {

/// Links that are pinned to each other, with a ball pinned to the last one.
struct HangingChain {
  static constexpr btScalar kLinkLength = 1, kBallRadius = btScalar(0.5);  // [m]

  int links;
  btScalar link_mass, ball_mass;  ///< [kg]
};

/// Hangs it along -y of a frame, by the frame's origin, on the world.
void AddHangingChain(World* world, const HangingChain& chain, const btTransform& frame);

}  // namespace cairn::bench
