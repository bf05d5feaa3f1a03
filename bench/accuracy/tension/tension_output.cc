// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "accuracy/command.h"
#include "accuracy/tension/tension.h"
#include "support/json_number.h"
#include "support/statistics.h"
#include "support/text_table.h"

namespace cairn::accuracy {
namespace {

using cli::Number;
using Json = nlohmann::ordered_json;

constexpr double kMillimetres = 1e3, kPercent = 1e2;

template <class T, class Of>
std::vector<T> Distinct(const std::vector<TensionResult>& results, Of of) {
  std::vector<T> found;
  for (const TensionResult& result : results) {
    const T value = of(result.cell);
    if (std::find(found.begin(), found.end(), value) == found.end()) found.push_back(value);
  }
  return found;
}

std::string GapOf(const TensionRun& run) {
  if (!run.failure.empty()) return "!";
  const double gap = kMillimetres * run.gap;
  return gap >= 1e4 ? fmt::format("{:.0f}e3", gap / 1e3) : cli::FormatNumber(gap);
}

void PrintGaps(const std::string& group, const std::vector<TensionResult>& results,
               std::span<const TensionSolver> solvers) {
  const auto links = Distinct<int>(results, [](const TensionCell& cell) { return cell.links; });
  std::vector<std::string> columns = {"solver"};
  for (const int count : links) columns.push_back(fmt::format("{} links", count));
  cli::TextTable table = cli::TableOf(columns);
  for (size_t s = 0; s < solvers.size(); ++s) {
    std::vector<std::string>& row = table.rows.emplace_back();
    row.push_back(solvers[s].name);
    for (const int count : links) {
      std::string& gaps = row.emplace_back();
      for (const TensionResult& result : results) {
        if (result.cell.links != count || GroupOf(result.cell) != group) continue;
        gaps += fmt::format("{}{}", gaps.empty() ? "" : " ", GapOf(result.runs[s]));
      }
    }
  }
  fmt::print("\n## {}: largest gap [mm]\n\n{}", group, table.ToMarkdown());
}

/// The value that is furthest from 0, in percent.
std::string Worst(const std::vector<double>& values) {
  double worst = cli::kNotMeasured;
  for (const double value : cli::Measured(values)) {
    if (std::isnan(worst) || std::abs(value) > std::abs(worst)) worst = value;
  }
  return cli::FormatNumber(kPercent * worst);
}

struct Sums {
  int cells = 0, torn = 0;
  std::vector<double> gap, gain, loss, spin, period, load, steps, cpu;

  void Add(const TensionResult& result, size_t solver) {
    const TensionRun& run = result.runs[solver];
    ++cells;
    torn += run.torn() ? 1 : 0;
    gap.push_back(kMillimetres * run.gap);
    if (run.torn()) return;
    gain.push_back(run.energy_gain);
    loss.push_back(run.energy_loss);
    spin.push_back(run.spin_change);
    steps.push_back(run.steps_taken);
    cpu.push_back(run.cpu_us / result.cell.links);
    if (result.differences.empty()) return;
    period.push_back(result.differences[solver].period);
    load.push_back(result.differences[solver].load);
  }
};

void PrintSums(const std::vector<TensionResult>& results, std::span<const TensionSolver> solvers) {
  cli::TextTable table =
      cli::TableOf({"cells", "solver", "torn", "gap mm", "energy gain %", "energy loss %", "spin %",
                    "period %", "load off %", "steps", "CPU us/link"});
  table.names = 2;
  const auto groups =
      Distinct<std::string>(results, [](const auto& cell) { return GroupOf(cell); });
  for (const std::string& group : groups) {
    for (size_t s = 0; s < solvers.size(); ++s) {
      Sums sums;
      for (const TensionResult& result : results) {
        if (GroupOf(result.cell) == group) sums.Add(result, s);
      }
      table.rows.push_back(
          {group, solvers[s].name, fmt::format("{}/{}", sums.torn, sums.cells),
           cli::FormatNumber(cli::Median(sums.gap)), Worst(sums.gain),
           cli::FormatNumber(kPercent * cli::Median(sums.loss)), Worst(sums.spin),
           Worst(sums.period), cli::FormatNumber(kPercent * cli::Median(sums.load)),
           cli::FormatNumber(cli::Mean(sums.steps)), cli::FormatNumber(cli::Median(sums.cpu))});
    }
  }
  fmt::print("\n## Sums\n\n{}", table.ToMarkdown());
}

Json ToJson(const TensionRun& run) {
  return {{"failure", run.failure},
          {"torn", run.torn()},
          {"gap_m", Number(run.gap)},
          {"energy_gain", Number(run.energy_gain)},
          {"energy_loss", Number(run.energy_loss)},
          {"angular_momentum_change", Number(run.spin_change)},
          {"subspace_steps_per_step", Number(run.steps_taken)},
          {"cpu_us_per_step", Number(run.cpu_us)},
          {"crossings_s", run.crossings}};
}

}  // namespace

void PrintTension(const std::vector<TensionResult>& results, std::span<const TensionSolver> solvers,
                  const TensionOptions& options) {
  std::string loads;
  for (const double load :
       Distinct<double>(results, [](const TensionCell& cell) { return cell.load; })) {
    loads += fmt::format("{}{:g}", loads.empty() ? "" : ", ", load);
  }
  fmt::print(
      "- chains of links of 1 kg and 1 m, {:g} s each; in a cell one figure for each load at the\n"
      "  end [kg]: {}; '!': a body faster than 1000 m/s\n"
      "- torn: a gap above {:g} mm; all after it is of cells that are not torn\n"
      "- energy over that of falling from level to straight down: most above the start, and loss\n"
      "  in the end (median); spin: change of angular momentum that nothing should change\n"
      "- period, load: against a run at {:g} Hz; the last passage below the pin, and where the "
      "load\n"
      "  is over the length of the chain (largest of a run, median of cells)\n",
      options.seconds, loads, kMillimetres * TensionOptions::kTorn, TensionOptions::kReferenceRate);
  for (const TensionSolver& solver : solvers) {
    fmt::print("- {}: {}, {} iterations\n", solver.name, solver.description, solver.iterations);
  }
  for (const std::string& group :
       Distinct<std::string>(results, [](const auto& cell) { return GroupOf(cell); })) {
    PrintGaps(group, results, solvers);
  }
  PrintSums(results, solvers);
}

Json ToJson(const std::vector<TensionResult>& results, std::span<const TensionSolver> solvers,
            const TensionOptions& options) {
  Json cells = Json::array();
  for (const TensionResult& result : results) {
    const TensionCell& cell = result.cell;
    Json runs = Json::object();
    for (size_t s = 0; s < solvers.size(); ++s) {
      Json run = ToJson(result.runs[s]);
      if (!result.differences.empty()) {
        run["period_off"] = Number(result.differences[s].period);
        run["load_off"] = Number(result.differences[s].load);
      }
      runs[solvers[s].name] = run;
    }
    cells.push_back({{"name", NameOf(cell)},
                     {"stage", NameOf(cell.stage)},
                     {"joint", NameOf(cell.link)},
                     {"limits", cell.limits},
                     {"links", cell.links},
                     {"load_kg", cell.load},
                     {"steps_per_second", cell.rate},
                     {"solvers", runs}});
  }
  return {{"seconds", options.seconds}, {"cells", cells}};
}

}  // namespace cairn::accuracy
