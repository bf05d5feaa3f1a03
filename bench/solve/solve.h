// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "solve/solve_options.h"
#include "solve/solve_result.h"

namespace cairn::cli {

/// Solves every problem with every solver. A single problem is solved once with an observer, which
/// measures its error over time and warms the caches up, and then as often as asked for without
/// one, which is what counts as its time.
/// @param command  what was typed, for the result
SolveResult Solve(const SolveOptions& options, const std::string& command);

}  // namespace cairn::cli
