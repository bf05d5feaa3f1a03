// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

#include "worlds/campaign.h"

namespace cairn::cli {

/// Everything about every world, as JSON, with the context of the run.
std::string WorldsToJson(const bench::CampaignOptions& options,
                         std::span<const bench::WorldResult> results, const std::string& command);

}  // namespace cairn::cli
