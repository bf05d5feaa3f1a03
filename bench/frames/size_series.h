// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "frames/scene_run.h"

namespace cairn::frames {

struct SeriesOptions {
  std::vector<SceneChoice> scenes;
  int frame = 30;   ///< The first that is looked at.
  int rounds = 31;  ///< Each measures everything that is compared once.
};

/// pyramid3d of these sizes.
std::vector<SceneChoice> Pyramids(const std::vector<int>& sizes);
/// "pyramid 100"
std::string NameOf(const SceneChoice& scene);

}  // namespace cairn::frames
