// SPDX-License-Identifier: MIT
#pragma once

#include "support/command.h"

namespace cairn::cli {

// The commands of the tool, each with its options and what it writes; one file each.
Command AddRunCommand(CLI::App* app);
Command AddSmallCommand(CLI::App* run);  ///< `cairn run small`
Command AddCompareCommand(CLI::App* app);
Command AddRecordCommand(CLI::App* app);
Command AddSolveCommand(CLI::App* app);
Command AddWorldsCommand(CLI::App* app);

}  // namespace cairn::cli
