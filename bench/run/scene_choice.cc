// SPDX-License-Identifier: MIT
#include "run/scene_choice.h"

#include <fmt/format.h>

#include <algorithm>

#include "support/command_line.h"
#include "support/failure.h"
#include "support/names.h"
#include "worlds/random_world.h"

namespace cairn::cli {
namespace {

std::vector<const bench::SceneInfo*> FindScenes(std::span<const std::string> words) {
  std::vector<std::string> names;
  for (const bench::SceneInfo& scene : bench::Scenes()) names.emplace_back(scene.name);
  names.emplace_back(bench::RandomScene::Info().name);
  std::vector<const bench::SceneInfo*> scenes;
  const auto add = [&scenes](const bench::SceneInfo& scene) {
    if (std::find(scenes.begin(), scenes.end(), &scene) == scenes.end()) scenes.push_back(&scene);
  };
  for (const std::string& word : words) {
    if (word == "all") {
      for (const bench::SceneInfo& scene : bench::Scenes()) add(scene);
    } else {
      const size_t index = FindName("scene", word, names, "'cairn list scenes' shows all");
      add(index < bench::Scenes().size() ? bench::Scenes()[index] : bench::RandomScene::Info());
    }
  }
  return scenes;
}

SceneChoice Choose(const bench::SceneInfo& scene, std::string_view size, std::uint64_t seed) {
  SceneChoice choice{.info = std::make_shared<bench::SceneInfo>(scene),
                     .make = [info = &scene] { return bench::Make(*info); },
                     .size = scene.default_size,
                     .seed = seed};
  if (!size.empty()) {
    choice.size = ParseInt("--size", size, scene.min_size, scene.max_size,
                           fmt::format("size of {}", scene.name));
  }
  return choice;
}

}  // namespace

SceneChoice ParseScene(std::string_view word, std::string_view size) {
  const auto take = [&word](char mark) {
    const std::string_view text = word.substr(std::min(word.find(mark), word.size()));
    word.remove_suffix(text.size());
    return text.substr(std::min<size_t>(1, text.size()));
  };
  const std::string_view frame = take('@'), own_size = take(':');
  const std::string name(word);
  SceneChoice choice =
      Choose(*FindScenes({&name, 1}).front(), own_size.empty() ? size : own_size, 0);
  if (!frame.empty()) {
    choice.frame = ParseInt("@FRAME", frame, 0, 1'000'000, "first frame");
  }
  return choice;
}

std::vector<SceneChoice> ParseScenes(std::span<const std::string> words, std::string_view size,
                                     std::uint64_t seed) {
  std::vector<SceneChoice> choices;
  for (const bench::SceneInfo* scene : FindScenes(words)) {
    choices.push_back(Choose(*scene, size, seed));
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
