// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "run/result.h"
#include "support/text_table.h"

namespace cairn::cli {

/// Scenes of which scaling was measured: ns for each row of a solve, with every number of threads
/// and every instruction set. Without rows if there is none.
TextTable ScalingTable(const RunResult& run);

/// The columns after scene and rows: "1 thread", "2 threads", "avx2" ...
std::vector<std::string> ScalingWays(const RunResult& run);

}  // namespace cairn::cli
