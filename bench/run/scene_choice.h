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
  int friction_directions = 2;  ///< 1 or 2, at each contact.
  int frame = -1;               ///< The first that is looked at, where its word names one.

  bench::SceneOptions options() const {
    return {.size = size, .seed = seed, .friction_directions = friction_directions};
  }
  int FirstFrame(int otherwise) const { return frame >= 0 ? frame : otherwise; }
};

/// "castle", "pyramid:100" (its size), "rubble@240" (its first frame) or "random:228" (a world of
/// `cairn worlds` and its seed).
/// @param size  of a word without one; empty is the default of the scene
/// @throws Failure (kUsage) if it is none of these, or there is no such scene or size.
SceneChoice ParseScene(std::string_view word, std::string_view size = "");

/// Scenes of the names typed, each once; "all" for every one but `random`. An empty size is the
/// default of each.
/// @throws Failure (kUsage) for an unknown name or a size that a scene does not have.
std::vector<SceneChoice> ParseScenes(std::span<const std::string> words, std::string_view size,
                                     std::uint64_t seed);

/// What became of the scene, for the result.
void ReadFacts(const bench::Scene& scene, const bench::World& world, SolverResult* result);

}  // namespace cairn::cli
