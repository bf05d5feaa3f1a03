// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include "run/scene_choice.h"

namespace cairn::cli {

/// Worlds as most games have them, of 1 to 400 bodies, in the order of the table: the scenes that
/// `cairn run small` runs, at sizes of its own. A new one is a scene, and one line here.
std::vector<SceneChoice> SmallWorlds();

/// Those of the names typed, each once; all without names. @throws Failure (kUsage)
std::vector<SceneChoice> ParseSmallWorlds(std::span<const std::string> words);

}  // namespace cairn::cli
