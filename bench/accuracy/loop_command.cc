// SPDX-License-Identifier: MIT
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "accuracy/command.h"
#include "accuracy/loop.h"
#include "accuracy/loop_output.h"
#include "accuracy/report.h"
#include "cli/command_line.h"
#include "cli/duration.h"
#include "cli/failure.h"
#include "cli/names.h"
#include "cli/output_file.h"

namespace cairn::accuracy {
namespace {

int RunLoops(const Common& common, const std::string& budgets, LoopOptions options,
             const std::string& typed) {
  options.scenes = common.Scenes(0);
  options.frames = common.frames;
  for (const std::string& word : cli::Split(budgets, ',')) {
    options.budgets.push_back(cli::ParseDuration("--budgets", word));
  }
  if (options.budgets.empty()) throw cli::Failure(cli::kUsage, "--budgets names no time");
  if (!common.json.empty()) cli::CheckWritable(common.json);
  const cli::RunContext context = cli::DescribeContext(typed);
  std::vector<LoopScene> scenes;
  {
    cli::Progress progress(cli::ParseProgress(common.words));
    for (const cli::SceneChoice& scene : options.scenes) {
      scenes.push_back(
          RunLoop(scene, options, [&](const std::string& text) { progress.Show(text); }));
    }
  }
  PrintContext("Scenes in closed loop", context);
  PrintLoop(scenes, options);
  nlohmann::ordered_json json = JsonHead("loop", context);
  json.update(ToJson(scenes, options));
  WriteJson(common.json, json);
  return cli::kFine;
}

}  // namespace

cli::Command AddLoopCommand(CLI::App* app) {
  CLI::App* const loop =
      app->add_subcommand("loop", "What becomes of the scenes, over many seeds, in a given time");
  const auto options = std::make_shared<LoopOptions>();
  const auto common = std::make_shared<Common>();
  common->frames = options->frames;
  const auto budgets = std::make_shared<std::string>("2ms,500us");
  AddScenes(loop, common.get());
  AddCommon(loop, common.get(), "Frames of each run");
  AddCount(loop, "--seeds", &options->seeds, 1, "Runs of each solver on each scene");
  cli::AddText(loop, "--budgets", budgets.get(), "Times for Cairn, with commas between them",
               "TIMES");
  return {loop,
          [=](const std::string& typed) { return RunLoops(*common, *budgets, *options, typed); }};
}

}  // namespace cairn::accuracy
