// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "cli/result.h"

namespace cairn::cli {

/// What the solvers were given, in numbers.
std::string ProblemCard(const SceneResult& scene);

/// What time depends on, where the run has it; else a line that says so.
std::string ScalingSection();

/// How the run was made, on what, and how far to trust it.
std::string MethodBox(const RunResult& run);

}  // namespace cairn::cli
