// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "run/result.h"

namespace cairn::cli {

/// What the solvers were given, in numbers.
std::string ProblemCard(const SceneResult& scene);

/// How the run was made, on what, and how far to trust it.
std::string MethodBox(const RunResult& run);

}  // namespace cairn::cli
