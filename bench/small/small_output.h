// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

#include "small/small_result.h"
#include "support/machine/run_context.h"
#include "support/text_table.h"

namespace cairn::cli {

/// A line for each world, and geometric means.
TextTable SmallTable(std::span<const SmallResult> worlds);

/// What the columns are, and where it was measured.
std::string SmallReadingHelp(const SmallOptions& options, const RunContext& context);

std::string SmallToJson(const SmallOptions& options, std::span<const SmallResult> worlds,
                        const RunContext& context);

}  // namespace cairn::cli
