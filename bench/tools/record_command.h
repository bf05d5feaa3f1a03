// SPDX-License-Identifier: MIT
#pragma once

#include "support/command.h"

namespace cairn::cli {

/// `cairn record`
Command AddRecordCommand(CLI::App* app);

}  // namespace cairn::cli
