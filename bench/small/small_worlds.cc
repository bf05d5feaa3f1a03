// SPDX-License-Identifier: MIT
#include "small/small.h"

#include <algorithm>

#include "support/names.h"

namespace cairn::cli {
namespace {

struct SmallWorld {
  const char* scene;
  int size;
};

constexpr SmallWorld kSmallWorlds[] = {
    {"incline", 1},       {"seesaw", 1},        {"door", 1},       {"pendulum", 5}, {"car", 1},
    {"growing-tower", 7}, {"tower", 10},        {"stairs", 1},     {"arch", 11},    {"slab", 6},
    {"dominoes", 100},    {"wrecking-ball", 6}, {"pyramid3d", 10},
};

}  // namespace

std::vector<SceneChoice> SmallWorlds() {
  std::vector<SceneChoice> worlds;
  for (const SmallWorld& world : kSmallWorlds) {
    const std::string name = world.scene;
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
