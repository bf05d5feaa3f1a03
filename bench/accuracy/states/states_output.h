// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>

#include "accuracy/states/states.h"

namespace cairn::accuracy {

/// How to read it, and tables of errors, work, frames and of what was compared.
void PrintStates(std::span<const SceneStates> scenes, const StatesOptions& options);

nlohmann::ordered_json ToJson(std::span<const SceneStates> scenes, const StatesOptions& options);

}  // namespace cairn::accuracy
