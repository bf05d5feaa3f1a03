// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "scenes/scene.h"

namespace cairn::cli {

/// What is true of a world after a frame; NaN where a fact does not apply.
struct FrameFacts {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  double energy = kNone;       ///< Kinetic and potential, of the dynamic bodies [J].
  double penetration = kNone;  ///< Of the deepest contact point [m].
  double height_lost = kNone;  ///< bench::SceneFacts::height_lost_m.
  double joint_gap = kNone;    ///< The largest [m].
  int contacts = 0;            ///< Contact points that the solver was given.
};

FrameFacts ReadFrameFacts(const bench::Scene& scene, const bench::World& world);

/// The mass of the heaviest dynamic body over that of the lightest; NaN without bodies.
double MassRatio(const bench::World& world);

}  // namespace cairn::cli
