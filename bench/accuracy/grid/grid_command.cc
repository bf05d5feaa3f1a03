// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "accuracy/command.h"
#include "accuracy/grid/grid.h"
#include "support/command_line.h"
#include "support/failure.h"
#include "support/names.h"
#include "support/output_file.h"

namespace cairn::accuracy {
namespace {

/// What is asked besides GridOptions.
struct GridChoice {
  std::string worlds = "all";
  bool quick = false;
};

std::vector<Cell> Choose(const GridChoice& choice) {
  const std::vector<std::string> names = {"all", "pile", "chain"};
  const size_t world = cli::FindName("world", choice.worlds, names, "write all, pile or chain");
  std::vector<Cell> cells = choice.quick ? QuickCells() : AllCells();
  std::erase_if(cells, [world](const Cell& cell) {
    return world != 0 && (cell.kind == Cell::Kind::kPile) != (world == 1);
  });
  return cells;
}

int RunGrid(const Common& common, const GridChoice& choice, GridOptions options,
            const std::string& typed) {
  options.frames = common.frames;
  const std::vector<Cell> cells = Choose(choice);
  if (!common.json.empty()) cli::CheckWritable(common.json);
  const cli::RunContext context = cli::DescribeContext(typed);
  std::vector<GridResult> results;
  {
    cli::Progress progress(cli::ParseProgress(common.words));
    for (const Cell& cell : cells) {
      progress.Show(fmt::format("{} of {}: {}", results.size() + 1, cells.size(), NameOf(cell)));
      results.push_back(RunCell(cell, options));
    }
  }
  fmt::print("{}", cli::Origin("A grid of extremes", context));
  PrintGrid(results, options);
  nlohmann::ordered_json json = JsonHead("grid", context);
  json.update(ToJson(results, options));
  WriteJson(common.json, json);
  const std::vector<std::string> sentences = NotNumbers(results);
  for (const std::string& sentence : sentences) {
    fmt::print(stderr, "cairn_accuracy: {}\n", sentence);
  }
  return sentences.empty() ? cli::kFine : cli::kCheckFailed;
}

}  // namespace

cli::Command AddGridCommand(CLI::App* app) {
  CLI::App* const grid =
      app->add_subcommand("grid", "Mass ratios, time steps, friction and chains to their extremes");
  const auto options = std::make_shared<GridOptions>();
  const auto choice = std::make_shared<GridChoice>();
  const auto common = std::make_shared<Common>();
  common->frames = options->frames;
  cli::AddText(grid, "--scenes", &choice->worlds, "all, pile or chain", "WORLDS");
  AddCommon(grid, common.get(), "Steps in each cell");
  AddCount(grid, "--iterations", &options->iterations, 1, "Of Bullet, and sweeps of Cairn");
  const std::map<std::string, StepPolicy> policies = {{"measured", StepPolicy::kMeasured},
                                                      {"always", StepPolicy::kAlways}};
  grid->add_option("--policy", options->policy, "When steps are taken: measured or always")
      ->transform(CLI::CheckedTransformer(policies));
  grid->add_flag("--quick", choice->quick, "A few cells only");
  return {grid,
          [=](const std::string& typed) { return RunGrid(*common, *choice, *options, typed); }};
}

}  // namespace cairn::accuracy
