// SPDX-License-Identifier: MIT
#include "run/scene_choice.h"

#include <fmt/format.h>

#include <algorithm>

#include "support/command_line.h"
#include "support/failure.h"
#include "support/names.h"

namespace cairn::cli {
namespace {

std::vector<const bench::SceneInfo*> FindScenes(std::span<const std::string> words) {
  std::vector<std::string> names;
  for (const bench::SceneInfo& scene : bench::Scenes()) names.emplace_back(scene.name);
  std::vector<const bench::SceneInfo*> scenes;
  const auto add = [&scenes](const bench::SceneInfo& scene) {
    if (std::find(scenes.begin(), scenes.end(), &scene) == scenes.end()) scenes.push_back(&scene);
  };
  for (const std::string& word : words) {
    if (word == "all") {
      for (const bench::SceneInfo& scene : bench::Scenes()) add(scene);
    } else {
      add(bench::Scenes()[FindName("scene", word, names, "'cairn list scenes' shows all")]);
    }
  }
  return scenes;
}

}  // namespace

std::vector<SceneChoice> ParseScenes(std::span<const std::string> words, std::string_view size,
                                     std::uint64_t seed) {
  std::vector<SceneChoice> choices;
  for (const bench::SceneInfo* scene : FindScenes(words)) {
    SceneChoice choice{.info = std::make_shared<bench::SceneInfo>(*scene),
                       .make = [scene] { return bench::Make(*scene); },
                       .size = scene->default_size,
                       .seed = seed};
    if (!size.empty()) {
      choice.size = static_cast<int>(ParseCount("--size", size, scene->min_size, scene->max_size,
                                                fmt::format("size of {}", scene->name)));
    }
    choices.push_back(choice);
  }
  return choices;
}

void ReadFacts(const bench::Scene& scene, const bench::World& world, SolverResult* result) {
  using Verdict = bench::SceneFacts::Verdict;
  const bench::SceneFacts facts = scene.Measure(world);
  result->facts = {{"height lost", "m", facts.height_lost_m},
                   {"joint gap", "m", facts.joint_gap_m},
                   {"penetration", "m", facts.penetration_m},
                   {"speed at rest", "m/s", facts.speed_at_rest_m_s}};
  if (facts.verdict != Verdict::kNotApplicable) {
    result->standing = facts.verdict == Verdict::kStanding;
  }
}

}  // namespace cairn::cli
