// SPDX-License-Identifier: MIT
#include "tools/seeds.h"

#include <fmt/format.h>

#include <algorithm>

#include "support/command_line.h"
#include "support/failure.h"
#include "support/names.h"
#include "worlds/random_world.h"

namespace cairn::cli {
namespace {

constexpr long long kMostWorlds = 10'000'000;

}  // namespace

std::vector<std::uint64_t> ParseSeedRange(const std::string& typed, long long most) {
  const size_t colon = typed.find(':');
  if (colon == std::string::npos) {
    throw Failure(kUsage, fmt::format("--seeds '{}' is no range: write FROM:TO, such as 0:400, "
                                      "without TO itself",
                                      typed));
  }
  const auto parse = [&](const std::string& text) {
    return ParseCount("--seeds", text, 0, most, "FROM:TO, numbers of worlds");
  };
  const long long from = parse(typed.substr(0, colon)), to = parse(typed.substr(colon + 1));
  if (from >= to) throw Failure(kUsage, fmt::format("--seeds {}: there are none", typed));
  if (to - from > kMostWorlds) {
    throw Failure(kUsage, fmt::format("--seeds {}: at most {} worlds", typed, kMostWorlds));
  }
  std::vector<std::uint64_t> seeds;
  for (long long seed = from; seed < to; ++seed) seeds.push_back(static_cast<std::uint64_t>(seed));
  return seeds;
}

void KeepKinds(const std::string& typed, std::vector<std::uint64_t>* seeds) {
  if (typed.empty()) return;
  std::vector<std::string> names;
  for (const bench::Kind& kind : bench::Kinds()) names.emplace_back(kind.name);
  std::vector<const bench::Kind*> kept;
  for (const std::string& word : Split(typed, ',')) {
    const size_t index = FindName("kind", word, names, "'cairn worlds --list' shows all");
    kept.push_back(&bench::Kinds()[index]);
  }
  std::erase_if(*seeds, [&](std::uint64_t seed) {
    return std::find(kept.begin(), kept.end(), &bench::KindOf(seed)) == kept.end();
  });
  if (seeds->empty()) throw Failure(kUsage, "none of the seeds is of that kind");
}

}  // namespace cairn::cli
