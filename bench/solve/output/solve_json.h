// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "solve/solve_result.h"

namespace cairn::cli {

/// The whole result, "schema_version": 1: `context` says where and how it was made, `settings` what
/// the solvers were told, `problems` holds what was measured for each solver. What was not is null.
std::string ToJson(const SolveResult& result);

}  // namespace cairn::cli
