// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "run/result.h"
#include "scenes/scene.h"

namespace cairn::cli {

/// A scene of a run.
struct SceneChoice {
  std::shared_ptr<const bench::SceneInfo> info;
  /// A new instance of the scene.
  std::function<std::unique_ptr<bench::Scene>()> make;
  int size = 0;
  std::uint64_t seed = 0;
};

/// Scenes of the names typed, each once; "all" for every one. An empty size is the default of each.
/// @throws Failure (kUsage) for an unknown name or a size that a scene does not have.
std::vector<SceneChoice> ParseScenes(std::span<const std::string> words, std::string_view size,
                                     std::uint64_t seed);

/// What became of the scene, for the result.
void ReadFacts(const bench::Scene& scene, const bench::World& world, SolverResult* result);

}  // namespace cairn::cli
