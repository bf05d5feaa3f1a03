// SPDX-License-Identifier: MIT
#include "accuracy/grid/grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "accuracy/command.h"
#include "support/json_number.h"
#include "support/statistics.h"
#include "support/text_table.h"

namespace cairn::accuracy {
namespace {

using cli::Number;
using Json = nlohmann::ordered_json;

constexpr double kMillimetres = 1e3;

/// Cells that share a line of the table of sums.
std::string GroupOf(const Cell& cell) {
  return cell.kind == Cell::Kind::kPile ? fmt::format("pile, 1:{:g}", cell.mass_ratio)
                                        : fmt::format("chain of {}", cell.links);
}

std::string Fate(const GridRun& run) {
  if (run.not_a_number) return "NaN";
  if (!run.failure.empty()) return "exploded";
  return "";
}

std::string DefectOf(const GridRun& run) {
  return run.failure.empty() ? Digits(kMillimetres * run.defect) : Fate(run);
}

void AddSums(const std::string& name, const std::vector<const GridResult*>& group,
             cli::TextTable* table) {
  const auto count = [&](auto condition) {
    return std::to_string(std::count_if(group.begin(), group.end(), condition));
  };
  const auto failed = [&](auto fails) {
    std::string text;
    for (const GridSolver solver : kGridSolvers) {
      if (!text.empty()) text += " / ";
      text += count([&](const GridResult* r) { return fails(r->Of(solver)); });
    }
    return text;
  };
  std::string defects;
  for (const GridSolver solver : kGridSolvers) {
    std::vector<double> values;
    for (const GridResult* r : group) values.push_back(kMillimetres * r->Of(solver).defect);
    if (!defects.empty()) defects += " / ";
    defects += Digits(cli::Median(values));
  }
  double accepted = 0, restored = 0;
  for (const GridResult* r : group) {
    accepted += r->Of(GridSolver::kSteps).accepted;
    restored += r->Of(GridSolver::kSteps).restored;
  }
  table->rows.push_back(
      {name, std::to_string(group.size()),
       failed([](const GridRun& run) { return run.not_a_number; }),
       failed([](const GridRun& run) { return !run.failure.empty() && !run.not_a_number; }),
       count([](const GridResult* r) { return r->GainsEnergy(); }),
       count([](const GridResult* r) { return r->Worse(); }),
       count([](const GridResult* r) { return r->Better(); }), defects,
       fmt::format("{:g} / {:g}", accepted, restored)});
}

void PrintSums(const std::vector<GridResult>& results) {
  cli::TextTable table = cli::TableOf({"cells", "number", "NaN", "exploded", "gain energy", "worse",
                                       "better", "defect mm", "steps accepted / restored"});
  std::vector<std::string> names;
  for (const GridResult& result : results) {
    const std::string name = GroupOf(result.cell);
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  for (const std::string& name : names) {
    std::vector<const GridResult*> group;
    for (const GridResult& result : results) {
      if (GroupOf(result.cell) == name) group.push_back(&result);
    }
    AddSums(name, group, &table);
  }
  fmt::print("\n## Sums\n\n");
  fmt::print("{}\n", table.ToMarkdown());
}

void PrintOutstanding(const std::vector<GridResult>& results) {
  cli::TextTable table = cli::TableOf({"cell", "what", "steps mm", "sweeps mm", "Bullet mm",
                                       "steps energy", "Bullet energy", "accepted", "restored"});
  int count = 0;
  for (const GridResult& result : results) {
    const GridRun &steps = result.Of(GridSolver::kSteps), &bullet = result.Of(GridSolver::kBullet);
    const std::string what = fmt::format("{}{}{}", Fate(steps), result.Worse() ? " worse" : "",
                                         result.GainsEnergy() ? " energy" : "");
    if (what.empty() && result.Of(GridSolver::kSweeps).failure.empty()) continue;
    ++count;
    table.rows.push_back({NameOf(result.cell), what, DefectOf(steps),
                          DefectOf(result.Of(GridSolver::kSweeps)), DefectOf(bullet),
                          Digits(steps.energy_gain), Digits(bullet.energy_gain),
                          std::to_string(steps.accepted), std::to_string(steps.restored)});
  }
  if (count == 0) {
    fmt::print(
        "- no cell stands out: no failure of Cairn, no energy beyond Bullet's, none worse\n");
    return;
  }
  fmt::print("## Cells that stand out\n\n");
  fmt::print("{}\n", table.ToMarkdown());
}

Json ToJson(const GridRun& run) {
  return {{"not_a_number", run.not_a_number}, {"failure", run.failure},
          {"failed_in_frame", run.failed_in}, {"energy_gain", Number(run.energy_gain)},
          {"defect_m", Number(run.defect)},   {"steps_accepted", run.accepted},
          {"steps_restored", run.restored}};
}

Json ToJson(const GridResult& result) {
  const Cell& cell = result.cell;
  return {{"name", NameOf(cell)},
          {"world", cell.kind == Cell::Kind::kPile ? "pile" : "chain"},
          {"mass_ratio", cell.mass_ratio},
          {"steps_per_second", cell.rate},
          {"friction", cell.friction},
          {"links", cell.links},
          {"steps", ToJson(result.Of(GridSolver::kSteps))},
          {"sweeps", ToJson(result.Of(GridSolver::kSweeps))},
          {"bullet", ToJson(result.Of(GridSolver::kBullet))},
          {"gains_energy", result.GainsEnergy()},
          {"worse_than_sweeps", result.Worse()},
          {"better_than_sweeps", result.Better()}};
}

}  // namespace

void PrintGrid(const std::vector<GridResult>& results, const GridOptions& options) {
  fmt::print(
      "- {} cells, {} frames each, {} iterations of Bullet and as many sweeps of Cairn, without a "
      "clock; steps {}\n"
      "- counts of three: Cairn with steps / with sweeps alone / Bullet; 'exploded': a body faster "
      "than 1000 m/s\n"
      "- gain energy: the most above the start, over what lifts all bodies by 1 m, is 1 % beyond "
      "Bullet's\n"
      "- defect: penetration and height lost of a pile, gap of a chain, mean over the second half; "
      "medians; worse, better: by a quarter and\n  1 mm than sweeps alone\n",
      results.size(), options.frames, options.iterations,
      options.policy == StepPolicy::kAlways ? "always" : "where they are predicted to pay");
  PrintSums(results);
  PrintOutstanding(results);
}

Json ToJson(const std::vector<GridResult>& results, const GridOptions& options) {
  Json cells = Json::array();
  for (const GridResult& result : results) cells.push_back(ToJson(result));
  return {{"frames", options.frames},
          {"iterations", options.iterations},
          {"policy", options.policy == StepPolicy::kAlways ? "always" : "measured"},
          {"cells", cells}};
}

}  // namespace cairn::accuracy
