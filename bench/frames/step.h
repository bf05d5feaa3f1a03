// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "frames/scene_run.h"

namespace cairn::frames {

struct StepOptions {
  std::vector<SceneChoice> scenes;
  int frame = 60;   ///< The first that is timed.
  int frames = 60;  ///< So many, one after the other.
};

/// Whole steps of two worlds, one with Bullet's stock solver and one with Cairn in its place (ten
/// iterations each, no subspace step, one thread), stepped in turn: what they take, and what of it
/// is spent outside of the solver, which no solver can make faster.
void PrintSteps(const StepOptions& options, const std::string& command);

}  // namespace cairn::frames
