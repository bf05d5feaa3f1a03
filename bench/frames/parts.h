// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "frames/scene_run.h"

namespace cairn::frames {

enum class Steps { kWherePredicted, kNone };

struct PartsOptions {
  std::vector<SceneChoice> scenes;
  int frame = 60;   ///< The first that is looked at.
  int frames = 60;  ///< So many, one after the other.
  Steps steps = Steps::kWherePredicted;
};

/// Where a substep of Cairn goes, in worlds that it drives itself, one thread: with what it works
/// on in the caches, and with caches emptied before.
void PrintParts(const PartsOptions& options, const std::string& command);

}  // namespace cairn::frames
