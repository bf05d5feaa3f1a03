// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>

#include "accuracy/loop/loop.h"

namespace cairn::accuracy {

/// How to read it, what was better than what, and a table for each scene.
void PrintLoop(std::span<const LoopScene> scenes, const LoopOptions& options);

nlohmann::ordered_json ToJson(std::span<const LoopScene> scenes, const LoopOptions& options);

}  // namespace cairn::accuracy
