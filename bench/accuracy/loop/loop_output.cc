// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "accuracy/command.h"
#include "accuracy/loop/loop.h"
#include "support/duration.h"
#include "support/json_number.h"
#include "support/statistics.h"
#include "support/text_table.h"

namespace cairn::accuracy {
namespace {

using Json = nlohmann::ordered_json;

std::vector<double> Values(const LoopSolver& solver, const LoopFigure& figure) {
  std::vector<double> values;
  for (const LoopFigures& run : solver.runs) values.push_back(run.*figure.value);
  return values;
}

/// What a scene is judged by: the first figure that applies to it.
const LoopFigure& MainFigure(const LoopScene& scene) {
  return *std::find_if(kLoopFigures.begin(), kLoopFigures.end(), [&](const LoopFigure& figure) {
    return !std::isnan(cli::Median(Values(scene.solvers.back(), figure)));
  });
}

void PrintScene(const LoopScene& scene) {
  std::vector<std::string> columns = {"solver", "effort", "collapsed"};
  for (const LoopFigure& figure : kLoopFigures) {
    columns.push_back(fmt::format("{} {}", figure.name, figure.unit));
  }
  cli::TextTable table = cli::TableOf(columns);
  for (const LoopSolver& solver : scene.solvers) {
    const bool falls = solver.can_fall || solver.collapsed > 0;
    std::vector<std::string> cells = {
        solver.name, solver.effort,
        falls ? fmt::format("{}/{}", solver.collapsed, solver.runs.size()) : "-"};
    for (const LoopFigure& figure : kLoopFigures) {
      cells.push_back(Digits(cli::Median(Values(solver, figure)) * figure.scale));
    }
    table.rows.push_back(cells);
  }
  fmt::print("\n## {} (judged by {}), {} seeds\n\n{}\n", scene.scene.info->name,
             MainFigure(scene).name, scene.seeds(), table.ToMarkdown());
  for (const LoopSolver& solver : scene.solvers) {
    for (const std::string& failure : solver.failures) {
      fmt::print("- {}, {}: {}\n", solver.name, solver.effort, failure);
    }
  }
}

Json ToJson(const LoopSolver& solver) {
  Json figures = Json::object(), failed = Json::array();
  for (const LoopFigure& figure : kLoopFigures) {
    Json runs = Json::array();
    for (const double value : Values(solver, figure)) runs.push_back(cli::Number(value));
    figures[figure.key] = {{"runs", runs}};
  }
  for (size_t i = 0; i < solver.runs.size(); ++i) {
    if (std::isinf(solver.runs[i].time)) failed.push_back(i + 1);
  }
  return {{"solver", solver.name},       {"effort", solver.effort},
          {"can_fall", solver.can_fall}, {"collapsed", solver.collapsed},
          {"failures", solver.failures}, {"failed_seeds", failed},
          {"figures", figures}};
}

}  // namespace

void PrintLoop(std::span<const LoopScene> scenes, const LoopOptions& options) {
  fmt::print(
      "- closed loop: each solver in a world of its own, {} frames of 1/60 s, {} seeds that "
      "displace bodies by up to 0.1 mm\n"
      "- figures: means over the second half of a run (speed: the largest), medians over seeds; a "
      "failed run counts as infinite\n"
      "- sweeps, accelerated, steps: the Bullet adapter with sweeps alone, with accelerated "
      "sweeps, and with subspace steps (the default),\n  Budget::Time for the whole substep; "
      "bullet-si: 10 iterations, however long they take\n"
      "- intervals, and what is significant: --json FILE, then "
      "python3 bench/accuracy/loop_tables.py FILE\n",
      options.frames, options.seeds);
  for (const LoopScene& scene : scenes) {
    if (scene.seeds() < options.seeds) {
      fmt::print("- stopped early: {} has {} seeds\n", scene.scene.info->name, scene.seeds());
    }
  }
  for (const LoopScene& scene : scenes) PrintScene(scene);
}

Json ToJson(std::span<const LoopScene> scenes, const LoopOptions& options) {
  Json list = Json::array(), budgets = Json::array();
  for (const LoopScene& scene : scenes) {
    Json solvers = Json::array();
    for (const LoopSolver& solver : scene.solvers) solvers.push_back(ToJson(solver));
    list.push_back({{"scene", scene.scene.info->name},
                    {"size", scene.scene.size},
                    {"judged_by", MainFigure(scene).key},
                    {"solvers", solvers}});
  }
  for (const auto budget : options.budgets) budgets.push_back(cli::Milliseconds(budget));
  return {{"frames", options.frames},
          {"seeds", options.seeds},
          {"budgets_ms", budgets},
          {"scenes", list}};
}

}  // namespace cairn::accuracy
