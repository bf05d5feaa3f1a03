// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "accuracy/command.h"
#include "accuracy/tension/tension.h"
#include "support/command_line.h"
#include "support/failure.h"
#include "support/names.h"
#include "support/output_file.h"

namespace cairn::accuracy {
namespace {

/// What is asked, as it is typed.
struct TensionChoice {
  std::string stages = "plane", joints = "pin", limits = "no", links = "10,30,100",
              loads = "1,10,100,1000,10000", rates = "60", solvers = "all";
  int reference_links = 0;
  double seconds = TensionOptions{}.seconds;
};

template <class Kind, size_t count>
std::vector<Kind> ParseKinds(std::string_view what, const std::string& text,
                             const std::array<Kind, count>& kinds) {
  if (text == "all") return {kinds.begin(), kinds.end()};
  std::vector<std::string> names;
  for (const Kind kind : kinds) names.emplace_back(NameOf(kind));
  std::vector<Kind> found;
  for (const std::string& word : cli::Split(text, ',')) {
    found.push_back(kinds[cli::FindName(what, word, names, "write all, or names of it")]);
  }
  return found;
}

std::vector<double> ParseNumbers(std::string_view option, const std::string& text, double least,
                                 double most) {
  std::vector<double> found;
  for (const std::string& word : cli::Split(text, ',')) {
    found.push_back(
        cli::ParseNumber(option, word, least, most, "numbers with commas between them"));
  }
  return found;
}

std::vector<bool> ParseLimits(const std::string& text) {
  const std::vector<std::string> words = {"no", "yes", "both"};
  const size_t word = cli::FindName("limits", text, words, "write no, yes or both");
  return word == 0   ? std::vector<bool>{false}
         : word == 1 ? std::vector<bool>{true}
                     : std::vector<bool>{false, true};
}

std::vector<TensionCell> CellsOf(const TensionChoice& choice) {
  std::vector<TensionCell> cells;
  const auto links = ParseNumbers("--links", choice.links, 1, 2000);
  const auto loads = ParseNumbers("--loads", choice.loads, 1e-3, 1e6);
  for (const double rate : ParseNumbers("--rates", choice.rates, 1, 1e5)) {
    for (const Stage stage : ParseKinds("stage", choice.stages, kStages)) {
      for (const Link link : ParseKinds("joint", choice.joints, kLinks)) {
        for (const bool limits : ParseLimits(choice.limits)) {
          if (limits && link == Link::kPin) continue;
          for (const double count : links) {
            for (const double load : loads) {
              cells.push_back({stage, link, limits, static_cast<int>(count), load, rate});
            }
          }
        }
      }
    }
  }
  return cells;
}

TensionResult Run(const TensionCell& cell, std::span<const TensionSolver> solvers,
                  const TensionChoice& choice, const TensionOptions& options) {
  TensionResult result{.cell = cell, .runs = {}, .differences = {}};
  for (const TensionSolver& solver : solvers) {
    result.runs.push_back(RunCell(cell, solver, options));
  }
  if (cell.links > choice.reference_links) return result;
  const TensionRun reference = RunReference(cell, options);
  for (const TensionRun& run : result.runs) {
    result.differences.push_back(Compare(run, reference, cell.links));
  }
  return result;
}

int RunTension(const Common& common, const TensionChoice& choice, const std::string& typed) {
  const TensionOptions options{.seconds = choice.seconds};
  const std::vector<TensionCell> cells = CellsOf(choice);
  const std::vector<TensionSolver> solvers = ParseTensionSolvers(choice.solvers);
  if (!common.json.empty()) cli::CheckWritable(common.json);
  const cli::RunContext context = cli::DescribeContext(typed);
  std::vector<TensionResult> results;
  {
    cli::Progress progress(cli::ParseProgress(common.words));
    for (const TensionCell& cell : cells) {
      progress.Show(fmt::format("{} of {}: {}", results.size() + 1, cells.size(), NameOf(cell)),
                    static_cast<double>(results.size()) / static_cast<double>(cells.size()));
      results.push_back(Run(cell, solvers, choice, options));
    }
  }
  fmt::print("{}", cli::Origin("Chains under tension", context));
  PrintTension(results, solvers, options);
  nlohmann::ordered_json json = JsonHead("tension", context);
  json.update(ToJson(results, solvers, options));
  WriteJson(common.json, json);
  return cli::kFine;
}

}  // namespace

std::vector<TensionSolver> ParseTensionSolvers(const std::string& text) {
  const std::span<const TensionSolver> all = TensionSolvers();
  if (text == "all") return {all.begin(), all.end()};
  std::vector<std::string> names;
  for (const TensionSolver& solver : all) names.push_back(solver.name);
  std::vector<TensionSolver> found;
  for (const std::string& word : cli::Split(text, ',')) {
    // a name that begins another one is meant itself
    found.push_back(all[cli::FindName("solver", word, names, "write all, or names of it")]);
  }
  return found;
}

cli::Command AddTensionCommand(CLI::App* app) {
  CLI::App* const tension =
      app->add_subcommand("tension", "Chains under heavy loads: gaps, energy, momentum, period");
  const auto choice = std::make_shared<TensionChoice>();
  const auto common = std::make_shared<Common>();
  const auto text = cli::TextAdder(tension);
  text("--stages", &choice->stages, "plane, space, free, or all", "NAMES");
  text("--joints", &choice->joints, "pin, hinge, cone-twist, six-dof, or all", "NAMES");
  text("--limits", &choice->limits, "Of angles: no, yes or both", "WORD");
  text("--links", &choice->links, "Lengths of the chains", "NUMBERS");
  text("--loads", &choice->loads, "Masses at their ends [kg], on links of 1 kg", "NUMBERS");
  text("--rates", &choice->rates, "Steps in a second", "NUMBERS");
  text("--solvers", &choice->solvers, "Names with commas between them, or all", "NAMES");
  tension->add_option("--seconds", choice->seconds, "Of each run")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  AddCount(tension, "--reference-links", &choice->reference_links, 0,
           "Chains of up to so many links are compared with a run at 3840 Hz");
  cli::AddText(tension, "--json", &common->json, "Write all figures to this file", "FILE");
  cli::AddText(tension, "--progress", &common->words.progress,
               "Progress on stderr: auto (if a terminal), always, never", "WHEN");
  return {tension, [=](const std::string& typed) { return RunTension(*common, *choice, typed); }};
}

}  // namespace cairn::accuracy
