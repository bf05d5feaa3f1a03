// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "accuracy/command.h"
#include "accuracy/states/states.h"
#include "support/command_line.h"
#include "support/failure.h"
#include "support/output_file.h"

namespace cairn::accuracy {
namespace {

int RunStates(const Common& common, std::uint64_t seed, StatesOptions options,
              const std::string& typed) {
  options.scenes = common.Scenes(seed);
  options.frames = common.frames;
  if (options.most < options.iterations) {
    throw cli::Failure(cli::kUsage, "--most is less than --iterations");
  }
  if (!common.json.empty()) cli::CheckWritable(common.json);
  const cli::RunContext context = cli::DescribeContext(typed);
  std::vector<SceneStates> scenes;
  {
    cli::Progress progress(cli::ParseProgress(common.words));
    for (const cli::SceneChoice& scene : options.scenes) {
      scenes.push_back(
          MeasureStates(scene, options, [&](const std::string& text) { progress.Show(text); }));
    }
  }
  fmt::print("{}", cli::Origin("Velocity errors on the same states", context));
  PrintStates(scenes, options);
  nlohmann::ordered_json json = JsonHead("states", context);
  json.update(ToJson(scenes, options));
  WriteJson(common.json, json);
  return cli::kFine;
}

}  // namespace

cli::Command AddStatesCommand(CLI::App* app) {
  CLI::App* const states = app->add_subcommand(
      "states",
      "Velocity errors in the time of Bullet's solver, on the same states.\n\n"
      "Bullet drives each scene, with many iterations. In every frame Cairn's solver for Bullet "
      "gets the same substep, with as much time as Bullet's whole solver takes for it with "
      "--iterations, as plain sweeps, as accelerated sweeps and with subspace steps; what comes "
      "out is thrown away, what the solvers learn is kept. In sampled frames velocities are "
      "compared with those of a converged solution.");
  const auto options = std::make_shared<StatesOptions>();
  const auto common = std::make_shared<Common>();
  common->frames = options->frames;
  const auto seed = std::make_shared<std::uint64_t>(0);
  AddScenes(states, common.get());
  AddCommon(states, common.get(), "Frames of each scene");
  states->add_option("--seed", *seed, "Of displacements by up to 0.1 mm; 0: none")
      ->capture_default_str();
  AddCount(states, "--samples", &options->samples, 1, "States of a scene, of 4 frames one at most");
  AddCount(states, "--iterations", &options->iterations, 1, "Of Bullet on each state");
  AddCount(states, "--advance", &options->advance, 1, "Iterations of Bullet that make the states");
  AddCount(states, "--rounds", &options->rounds, 1, "Solves of each state by Bullet, to time it");
  AddCount(states, "--most", &options->most, 1,
           "Iterations of Bullet followed to see what it takes");
  AddCount(states, "--reference", &options->reference, 1,
           "Relaxations of rows that a reference may take, in millions");
  return {states,
          [=](const std::string& typed) { return RunStates(*common, *seed, *options, typed); }};
}

}  // namespace cairn::accuracy
