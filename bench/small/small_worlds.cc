// SPDX-License-Identifier: MIT
#include "small/small.h"

#include <algorithm>

#include "scenes/small_scenes.h"
#include "support/names.h"

namespace cairn::cli {

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
  std::vector<std::string> names;
  for (const SceneChoice& world : all) names.emplace_back(world.info->name);
  std::vector<bool> chosen(all.size());
  for (const std::string& word : words) {
    chosen[FindName("small world", word, names, "'cairn run small --help' shows all")] = true;
  }
  std::vector<SceneChoice> worlds;
  for (size_t i = 0; i < all.size(); ++i) {
    if (chosen[i]) worlds.push_back(all[i]);
  }
  return worlds;
}

}  // namespace cairn::cli
