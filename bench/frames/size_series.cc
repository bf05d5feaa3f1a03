// SPDX-License-Identifier: MIT
#include "frames/size_series.h"

#include <fmt/format.h>

namespace cairn::frames {

std::vector<SceneChoice> Pyramids(const std::vector<int>& sizes) {
  std::vector<SceneChoice> scenes;
  for (const int size : sizes) scenes.push_back({.name = "pyramid3d", .size = size});
  return scenes;
}

std::string NameOf(const SceneChoice& scene) {
  return scene.size > 0 ? fmt::format("{} {}", scene.name, scene.size) : scene.name;
}

}  // namespace cairn::frames
