// SPDX-License-Identifier: MIT
#include "tools/words.h"

#include <fmt/format.h>

#include <algorithm>

#include "CLI/CLI.hpp"
#include "support/command_line.h"
#include "support/duration.h"

namespace cairn::cli {

CLI::Option* AddScenes(CLI::App* app, const char* what, SceneWords* words) {
  return app
      ->add_option("scene", words->scenes, fmt::format("Scenes to {}; 'all' for every one", what))
      ->type_name("SCENE");
}

void AddSceneOptions(CLI::App* app, SceneWords* words) {
  AddText(app, "--size", &words->size, "Size of the scene; see cairn list scenes", "N");
  AddText(app, "--seed", &words->seed,
          "Displaces bodies by up to 0.1 mm, differently for each seed; default 0: none", "N");
  AddDirections(app, &words->directions);
}

void AddDirections(CLI::App* app, std::string* directions) {
  AddText(app, "--directions", directions,
          "Of friction at a contact: 1, as Bullet comes, or 2; default 2. Random worlds draw it",
          "N");
}

void TakeDirections(const std::string& directions, std::vector<SceneChoice>* scenes) {
  const int count = ParseInt("--directions", directions, 1, 2, "directions of friction");
  for (SceneChoice& scene : *scenes) scene.friction_directions = count;
}

void Parse(const SceneWords& scenes, const EffortWords& effort, RunOptions* options) {
  options->seed = ParseCount("--seed", scenes.seed, 0, 1'000'000'000,
                             "0: the scene as designed, else displaced by up to 0.1 mm");
  options->scenes = ParseScenes(scenes.scenes, scenes.size, options->seed);
  TakeDirections(scenes.directions, &options->scenes);
  if (!effort.budget.empty()) {
    const FrameBudget budget = ParseBudget("--budget", effort.budget);
    options->budget = budget.time;
    options->units = budget.units;
  }
  if (!effort.iterations.empty()) {
    options->iterations = ParseIterations("--iterations", effort.iterations);
  }
}

bool AnyFit(const RunOptions& options) {
  const auto is_fit = [](const IterationRule& rule) {
    return rule.kind == IterationRule::Kind::kFit;
  };
  return is_fit(options.iterations) ||
         std::ranges::any_of(options.solvers, [&](const SolverChoice& solver) {
           return solver.own_iterations && is_fit(*solver.own_iterations);
         });
}

void AddSetup(CLI::App* app, SetupWords* words) {
  AddText(app, "--threads", &words->threads, "Threads that Cairn may use; default 1", "N");
  AddText(app, "--simd", &words->simd, "SIMD target of Cairn instead of the best; see cairn doctor",
          "TARGET");
  AddText(app, "--pin", &words->pin, "Stays on this core, counted from 0", "CORE");
}

Setup Parse(const SetupWords& words) { return ParseSetup(words.threads, words.simd, words.pin); }

}  // namespace cairn::cli
