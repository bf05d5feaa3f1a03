// SPDX-License-Identifier: MIT
#pragma once

#include "support/command.h"

namespace cairn::cli {

/// `cairn run`: its options, and what it writes.
Command AddRunCommand(CLI::App* app);

}  // namespace cairn::cli
