// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace cairn::cli {

/// Seeds of random worlds, of "FROM:TO" without TO itself. @throws Failure (kUsage)
std::vector<std::uint64_t> ParseSeedRange(const std::string& typed, long long most);

/// Leaves the seeds of the kinds named, all where none is. @throws Failure (kUsage)
void KeepKinds(const std::string& typed, std::vector<std::uint64_t>* seeds);

}  // namespace cairn::cli
