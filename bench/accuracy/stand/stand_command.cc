// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "accuracy/command.h"
#include "accuracy/stand/stand.h"
#include "support/command_line.h"
#include "support/failure.h"
#include "support/output_file.h"

namespace cairn::accuracy {
namespace {

struct StandChoice {
  std::string scene = "heavy-top", solvers = "cairn";
  StandOptions options;
  int directions = 2;
  int iterations = 0;  ///< 0: those of each solver
};

int RunStandCommand(const Common& common, const StandChoice& choice, const std::string& typed) {
  StandOptions options = choice.options;
  options.scene = cli::ParseScene(choice.scene);
  options.scene.friction_directions = choice.directions;
  std::vector<TensionSolver> solvers = ParseTensionSolvers(choice.solvers);
  for (TensionSolver& solver : solvers) {
    if (choice.iterations > 0) solver.iterations = choice.iterations;
  }
  if (!common.json.empty()) cli::CheckWritable(common.json);
  const cli::RunContext context = cli::DescribeContext(typed);
  std::vector<StandResult> results;
  {
    cli::Progress progress(cli::ParseProgress(common.words));
    for (const TensionSolver& solver : solvers) {
      options.progress = [&](int done) {
        progress.Show(fmt::format("{}: {} of {}", solver.name, done, options.seeds),
                      static_cast<double>(done) / options.seeds);
      };
      results.push_back({solver, RunStand(options, solver)});
    }
  }
  fmt::print("{}", cli::Origin(fmt::format("Whether {} stands", choice.scene), context));
  PrintStand(results, options);
  nlohmann::ordered_json json = JsonHead("stand", context);
  json.update(ToJson(results, options));
  WriteJson(common.json, json);
  return cli::kFine;
}

}  // namespace

cli::Command AddStandCommand(CLI::App* app) {
  CLI::App* const stand = app->add_subcommand(
      "stand", "One scene displaced by many seeds: falls, and how far it sinks");
  const auto choice = std::make_shared<StandChoice>();
  const auto common = std::make_shared<Common>();
  const auto text = cli::TextAdder(stand);
  text("--scene", &choice->scene, "Its name, or with its size: heavy-top:20", "NAME");
  text("--solvers", &choice->solvers, "Those of tension, with commas between them, or all",
       "NAMES");
  AddCount(stand, "--first", &choice->options.first, 0, "Seed; 0 is the scene as it is designed");
  AddCount(stand, "--seeds", &choice->options.seeds, 1, "How many");
  AddCount(stand, "--jobs", &choice->options.jobs, 1, "Runs side by side");
  stand->add_option("--seconds", choice->options.seconds, "Of each run, at 60 Hz")
      ->check(CLI::Range(1.0, 3600.0))
      ->capture_default_str();
  stand->add_option("--slop", choice->options.slop, "m_linearSlop [m]; Bullet has 0")
      ->check(CLI::Range(0.0, 1.0));
  stand->add_option("--erp", choice->options.erp, "m_erp2, of contacts; Bullet has 0.2")
      ->check(CLI::Range(0.0, 1.0));
  stand
      ->add_option("--directions", choice->directions,
                   "Of friction at a contact: 1, as Bullet comes, or 2")
      ->check(CLI::Range(1, 2))
      ->capture_default_str();
  stand
      ->add_option("--iterations", choice->iterations,
                   "m_numIterations, of all solvers; without: their own, mostly 10")
      ->check(CLI::Range(1, 10000));
  cli::AddText(stand, "--json", &common->json, "Write all figures to this file", "FILE");
  cli::AddText(stand, "--progress", &common->words.progress,
               "Progress on stderr: auto (if a terminal), always, never", "WHEN");
  return {stand,
          [=](const std::string& typed) { return RunStandCommand(*common, *choice, typed); }};
}

}  // namespace cairn::accuracy
