// SPDX-License-Identifier: MIT
#pragma once

#include "scenes/scene.h"
#include "support/statistics.h"

namespace cairn::cli {

/// What is true of a world after a frame; NaN where a fact does not apply.
struct FrameFacts {
  double energy = kNotMeasured;       ///< Kinetic and potential, of the dynamic bodies [J].
  double penetration = kNotMeasured;  ///< Of the deepest contact point [m].
  double height_lost = kNotMeasured;  ///< bench::SceneFacts::height_lost_m.
  double joint_gap = kNotMeasured;    ///< The largest [m].
  int contacts = 0;                   ///< Contact points that the solver was given.
};

FrameFacts ReadFrameFacts(const bench::Scene& scene, const bench::World& world);

/// The mass of the heaviest dynamic body over that of the lightest; NaN without bodies.
double MassRatio(const bench::World& world);

}  // namespace cairn::cli
