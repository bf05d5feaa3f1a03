// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "accuracy/grid/grid.h"

namespace cairn::accuracy {

/// How to read it, a table of sums, and one of the cells that stand out.
void PrintGrid(const std::vector<GridResult>& results, const GridOptions& options);

nlohmann::ordered_json ToJson(const std::vector<GridResult>& results, const GridOptions& options);

}  // namespace cairn::accuracy
