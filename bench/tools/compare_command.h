// SPDX-License-Identifier: MIT
#pragma once

#include "support/command.h"

namespace cairn::cli {

Command AddCompareCommand(CLI::App* app);

}  // namespace cairn::cli
