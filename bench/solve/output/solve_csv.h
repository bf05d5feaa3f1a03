// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "solve/solve_result.h"

namespace cairn::cli {

/// A line for each problem and solver. Cells of what was not measured are empty.
std::string ToCsv(const SolveResult& result);

/// A line for each iterate that was kept: error over time.
std::string HistoryToCsv(const SolveResult& result);

}  // namespace cairn::cli
