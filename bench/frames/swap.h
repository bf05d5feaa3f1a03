// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "frames/scene_run.h"

namespace cairn::frames {

struct SwapOptions {
  std::vector<SceneChoice> scenes;
  int frame = 60;   ///< The first that is looked at.
  int frames = 40;  ///< So many, one after the other.
};

/// Bullet's stock solver against Cairn in its place, on the very same substeps of worlds that
/// Bullet drives: ten sweeps, no subspace step, one thread, from prepareSolve() to the end of
/// allSolved().
void PrintSwaps(const SwapOptions& options, const std::string& command);

}  // namespace cairn::frames
