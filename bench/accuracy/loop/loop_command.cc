// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <chrono>
#include <csignal>
#include <memory>
#include <nlohmann/json.hpp>
#include <ratio>
#include <string>
#include <vector>

#include "accuracy/command.h"
#include "accuracy/loop/loop.h"
#include "support/command_line.h"
#include "support/duration.h"
#include "support/failure.h"
#include "support/names.h"
#include "support/output_file.h"

namespace cairn::accuracy {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void Interrupt(int) { interrupted = 1; }

/// What is asked besides LoopOptions.
struct LoopChoice {
  std::string budgets = "2ms,500us";
  double minutes = 0;
};

int RunLoop(const Common& common, const LoopChoice& choice, LoopOptions options,
            const std::string& typed) {
  options.scenes = common.Scenes(0);
  options.frames = common.frames;
  for (const std::string& word : cli::Split(choice.budgets, ',')) {
    options.budgets.push_back(cli::ParseDuration("--budgets", word));
  }
  if (options.budgets.empty()) throw cli::Failure(cli::kUsage, "--budgets names no time");
  if (!common.json.empty()) cli::CheckWritable(common.json);
  const cli::RunContext context = cli::DescribeContext(typed);
  std::vector<LoopScene> scenes;
  {
    cli::Progress progress(cli::ParseProgress(common.words));
    const auto begin = std::chrono::steady_clock::now();
    std::signal(SIGINT, &Interrupt);
    scenes = RunLoops(
        options, [&](const std::string& text) { progress.Show(text); },
        [&] {
          const std::chrono::duration<double, std::ratio<60>> spent =
              std::chrono::steady_clock::now() - begin;
          return interrupted != 0 || (choice.minutes > 0 && spent.count() >= choice.minutes);
        });
    std::signal(SIGINT, SIG_DFL);
  }
  fmt::print("{}", cli::Origin("Scenes in closed loop", context));
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
  const auto choice = std::make_shared<LoopChoice>();
  AddScenes(loop, common.get());
  AddCommon(loop, common.get(), "Frames of each run");
  AddCount(loop, "--seeds", &options->seeds, 1, "Runs of each solver on each scene");
  loop->add_option(
          "--minutes", choice->minutes,
          "Ends after the run in which so many are over, as Ctrl-C does; 0: when all is done")
      ->check(CLI::Range(0.0, 1e4))
      ->capture_default_str();
  cli::AddText(loop, "--budgets", &choice->budgets, "Times for Cairn, with commas between them",
               "TIMES");
  return {loop,
          [=](const std::string& typed) { return RunLoop(*common, *choice, *options, typed); }};
}

}  // namespace cairn::accuracy
