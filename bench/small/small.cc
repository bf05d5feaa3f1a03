// SPDX-License-Identifier: MIT
#include "small/small.h"

#include <fmt/format.h>

#include <algorithm>

#include "scenes/small_scenes.h"
#include "support/failure.h"
#include "support/statistics.h"
#include "worlds/random_world.h"

namespace cairn::cli {

std::span<const SolverChoice> SmallSolvers() {
  static const std::vector<SolverChoice> solvers = ParseSolvers("bullet-si,cairn-pgs,cairn");
  return solvers;
}

double HotRatio(const SmallResult& world, size_t solver) {
  return world.solvers[solver].hot / world.solvers.front().hot;
}

double ColdRatio(const SmallResult& world, size_t solver) {
  return world.solvers[solver].cold / world.solvers.front().cold;
}

double ErrorRatio(const SmallResult& world, size_t solver) {
  const std::vector<double>& errors = world.solvers[solver].errors;
  const std::vector<double>& of_first = world.solvers.front().errors;
  std::vector<double> ratios;
  for (size_t i = 0; i < errors.size(); ++i) {
    if (of_first[i] >= kLeastError) ratios.push_back(errors[i] / of_first[i]);
  }
  return Median(ratios);
}

bool AnyCairnFailed(std::span<const SmallResult> worlds) {
  for (const SmallResult& world : worlds) {
    for (size_t i = 0; i < world.solvers.size(); ++i) {
      const bool is_ours = SmallSolvers()[i].entry->maker == Maker::kCairn;
      if (is_ours && world.solvers[i].failure) return true;
    }
  }
  return false;
}

std::vector<SceneChoice> SmallWorlds() {
  std::vector<SceneChoice> worlds;
  for (const bench::SmallScene& world : bench::kSmallScenes) {
    const std::string name = world.name;
    worlds.push_back(ParseScenes({&name, 1}, std::to_string(world.size), 0).front());
  }
  return worlds;
}

std::vector<SceneChoice> ParseSmallWorlds(std::span<const std::string> words) {
  const std::vector<SceneChoice> all = SmallWorlds();
  if (words.empty()) return all;
  std::vector<SceneChoice> worlds;
  for (const std::string& word : words) {
    const auto usual = std::find_if(all.begin(), all.end(), [&word](const SceneChoice& world) {
      return world.info->name == word;
    });
    worlds.push_back(usual == all.end() ? ParseScene(word) : *usual);
    if (worlds.back().frame >= 0) {
      throw Failure(kUsage, fmt::format("small worlds start at frame 0: leave out the frame of "
                                        "'{}'; --warmup skips frames",
                                        word));
    }
  }
  return worlds;
}

std::vector<SceneChoice> RandomWorlds(std::span<const std::uint64_t> seeds) {
  const std::string name(bench::RandomScene::Info().name);
  std::vector<SceneChoice> worlds;
  for (const std::uint64_t seed : seeds) {
    worlds.push_back(ParseScenes({&name, 1}, std::to_string(seed), 0).front());
  }
  return worlds;
}

}  // namespace cairn::cli
