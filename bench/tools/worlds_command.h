// SPDX-License-Identifier: MIT
#pragma once

#include "support/command.h"

namespace cairn::cli {

/// `cairn worlds`: its options, and what it writes.
Command AddWorldsCommand(CLI::App* app);

}  // namespace cairn::cli
