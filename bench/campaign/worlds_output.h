// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

#include "worlds/campaign.h"

namespace cairn::cli {

/// What all worlds came to, and each kind, solver by solver.
std::string WorldTables(std::span<const bench::WorldResult> results,
                        std::span<const bench::Variant> variants);

/// A line for each world and solver that failed; none without failures.
std::string FailedWorlds(std::span<const bench::WorldResult> results,
                         std::span<const bench::Variant> variants);

/// One world in detail.
/// @param description  of the world
std::string WorldReport(const bench::WorldResult& result, const std::string& description,
                        std::span<const bench::Variant> variants);

}  // namespace cairn::cli
