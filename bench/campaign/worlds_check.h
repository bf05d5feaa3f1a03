// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "worlds/campaign.h"

namespace cairn::cli {

/// Runs the worlds again with one thread on every SIMD target of this machine, and with two and
/// three on the best; results that differ get a finding. Changes CAIRN_SIMD meanwhile.
void CheckBits(const bench::CampaignOptions& options, std::vector<bench::WorldResult>* results);

/// Shrinks each failure and writes into a folder: seed-N-SOLVER.txt, which says what is left and
/// how to run it, and seed-N-SOLVER.cairn, the problem of its worst frame.
/// @return a line for each. @throws Failure (kBadInput), from MakeFolder() before a long run
std::string ShrinkFailures(const bench::CampaignOptions& options,
                           const std::vector<bench::WorldResult>& results,
                           const std::string& folder);

void MakeFolder(const std::string& folder);

/// The sentence that describes a world.
std::string DescribeWorld(const bench::WorldSeed& seed);

}  // namespace cairn::cli
