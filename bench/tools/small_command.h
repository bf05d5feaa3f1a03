// SPDX-License-Identifier: MIT
#pragma once

#include "support/command.h"

namespace cairn::cli {

/// Adds `cairn run small`. @p run  the command `cairn run`
Command AddSmallCommand(CLI::App* run);

}  // namespace cairn::cli
