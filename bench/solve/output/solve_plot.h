// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "solve/solve_result.h"

namespace cairn::cli {

/// A picture that stands alone (SVG): for each problem, error over time, or the residual where no
/// error was measured.
std::string ToSvg(const SolveResult& result);

}  // namespace cairn::cli
