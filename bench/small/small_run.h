// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "small/small_result.h"

namespace cairn::cli {

/// Each solver in worlds of its own, stepped in turn: once with nothing but each other beside them,
/// once with caches emptied before each step. Then errors, see SameStates.
std::vector<SmallResult> RunSmall(const SmallOptions& options);

}  // namespace cairn::cli
