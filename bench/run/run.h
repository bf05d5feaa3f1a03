// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "run/options.h"
#include "run/result.h"

namespace cairn::cli {

/// Simulates and measures. All solvers of a scene step in turn, frame by frame, so that whatever
/// disturbs the machine disturbs all alike.
/// @param command  what was typed, for the result
RunResult Run(const RunOptions& options, const std::string& command);

}  // namespace cairn::cli
