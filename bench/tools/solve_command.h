// SPDX-License-Identifier: MIT
#pragma once

#include "support/command.h"

namespace cairn::cli {

/// `cairn solve`: its options, and what it writes.
Command AddSolveCommand(CLI::App* app);

}  // namespace cairn::cli
