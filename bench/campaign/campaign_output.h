// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "worlds/campaign.h"

namespace cairn::cli {

/// What all worlds came to, and each kind, solver by solver. @p bits: whether those were looked at.
std::string WorldTables(std::span<const bench::WorldResult> results,
                        std::span<const bench::Variant> variants, bool bits);

/// What a player sees: by solver the geometric means of ratios to Bullet's run with the iterations
/// of the world, where that one's are not too small to mean anything, and how many are more than a
/// tenth smaller or larger.
std::string BesideTable(std::span<const bench::WorldResult> results,
                        std::span<const bench::Variant> variants);

/// A line for each world and solver that failed; none without failures.
std::string FailedWorlds(std::span<const bench::WorldResult> results,
                         std::span<const bench::Variant> variants);

/// One world in detail.
/// @param description  of the world
std::string WorldReport(const bench::WorldResult& result, const std::string& description,
                        std::span<const bench::Variant> variants);

/// Everything about every world, as JSON, with the context of the run.
std::string WorldsToJson(const bench::CampaignOptions& options,
                         std::span<const bench::WorldResult> results, const std::string& command);

/// Reads Bullet's runs from files of WorldsToJson().
/// @throws Failure (kUsage) if one cannot be read, or is of other worlds than those of the options,
/// or of another Bullet than this one.
bench::BulletRuns ReadBulletRuns(std::span<const std::string> files,
                                 const bench::CampaignOptions& options);

/// What became of worlds in an earlier run, by seed and solver.
using EarlierRuns = std::unordered_map<std::uint64_t, std::map<std::string, bench::Trial>>;

/// Reads all runs from a file of WorldsToJson(), of this or another build, under these conditions
/// or others. @throws Failure (kUsage) if it cannot be read, or is of other lengths.
EarlierRuns ReadEarlierRuns(const std::string& path, const bench::CampaignOptions& options);

/// How runs differ from earlier ones: by solver the geometric means of ratios, of the worlds whose
/// bits differ, and how many are more than a tenth smaller or larger.
std::string AgainstTable(std::span<const bench::WorldResult> results,
                         std::span<const bench::Variant> variants, const EarlierRuns& earlier);

/// Runs the worlds again with one thread on every SIMD target of this machine, and with two and
/// three on the best; results that differ get a finding. Changes CAIRN_SIMD meanwhile.
void CheckBits(const bench::CampaignOptions& options, std::vector<bench::WorldResult>* results);

/// Shrinks each failure and writes into a folder: seed-N-SOLVER.txt, which says what is left and
/// how to run it, and seed-N-SOLVER.cairn, the problem of its worst frame.
/// @return a line for each. @throws Failure (kBadInput)
std::string ShrinkFailures(const bench::CampaignOptions& options,
                           const std::vector<bench::WorldResult>& results,
                           const std::string& folder);

/// The sentence that describes a world.
std::string DescribeWorld(const bench::WorldSeed& seed);

}  // namespace cairn::cli
