// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "compare/comparison.h"

namespace cairn::cli {

/// A row for each lane, below them the sentences.
std::string ToText(const Comparison& comparison);

/// The same, "schema_version": 1. Ratios are of the later run and the earlier; what was not
/// measured is null.
std::string ToJson(const Comparison& comparison);

}  // namespace cairn::cli
