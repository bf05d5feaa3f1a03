// SPDX-License-Identifier: MIT
#include "accuracy/loop_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "accuracy/intervals.h"
#include "accuracy/report.h"
#include "cli/duration.h"
#include "cli/json_number.h"
#include "frames/markdown.h"

namespace cairn::accuracy {
namespace {

using cli::Number;
using Json = nlohmann::ordered_json;

std::vector<double> Values(const LoopLane& lane, const LoopFigure& figure) {
  std::vector<double> values;
  for (const LoopFigures& run : lane.runs) values.push_back(run.*figure.value * figure.scale);
  return values;
}

/// What a scene is judged by: the first figure that applies to it.
const LoopFigure& MainFigure(const LoopScene& scene) {
  return *std::find_if(kLoopFigures.begin(), kLoopFigures.end(), [&](const LoopFigure& figure) {
    return !std::isnan(MedianInterval(Values(scene.lanes.back(), figure)).value);
  });
}

/// Runs, of the same seed, in which a lane is better than another.
int BetterRuns(const LoopLane& lane, const LoopLane& other, const LoopFigure& figure) {
  int better = 0;
  for (size_t i = 0; i < lane.runs.size(); ++i) {
    better += lane.runs[i].*figure.value < other.runs[i].*figure.value ? 1 : 0;
  }
  return better;
}

std::string Collapses(const LoopLane& lane) {
  if (!lane.can_fall && lane.collapsed == 0) return "-";
  const int runs = static_cast<int>(lane.runs.size());
  const Interval share = ShareInterval(lane.collapsed, runs);
  return fmt::format("{}/{} [{:.0f}, {:.0f}] %", lane.collapsed, runs, 100 * share.low,
                     100 * share.high);
}

std::string MedianText(const LoopLane& lane, const LoopFigure& figure) {
  const Interval median = MedianInterval(Values(lane, figure));
  if (std::isnan(median.value)) return "-";
  if (median.low == median.high) return Digits(median.value);
  return fmt::format("{} [{}, {}]", Digits(median.value), Digits(median.low), Digits(median.high));
}

void PrintScene(const LoopScene& scene) {
  std::vector<std::string> columns = {"solver", "effort", "collapsed"};
  for (const LoopFigure& figure : kLoopFigures) {
    columns.push_back(fmt::format("{} {}", figure.name, figure.unit));
  }
  columns.insert(columns.end(), {"better than Bullet", "than sweeps"});
  frames::MarkdownTable table(columns);
  const LoopFigure& main = MainFigure(scene);
  for (size_t i = 0; i < scene.lanes.size(); ++i) {
    const LoopLane& lane = scene.lanes[i];
    std::vector<std::string> cells = {lane.solver, lane.effort, Collapses(lane)};
    for (const LoopFigure& figure : kLoopFigures) cells.push_back(MedianText(lane, figure));
    const auto against = [&](const LoopLane& other) {
      return fmt::format("{}/{}", BetterRuns(lane, other, main), lane.runs.size());
    };
    const bool is_bullet = i + 1 == scene.lanes.size(), is_steps = !is_bullet && i % 2 == 0;
    cells.push_back(is_bullet ? "-" : against(scene.lanes.back()));
    cells.push_back(is_steps ? against(scene.lanes[i + 1]) : "-");
    table.Add(cells);
  }
  fmt::print("\n## {} (judged by {})\n\n", scene.scene.info->name, main.name);
  table.Print();
  for (const LoopLane& lane : scene.lanes) {
    for (const std::string& failure : lane.failures) {
      fmt::print("- {}, {}: {}\n", lane.solver, lane.effort, failure);
    }
  }
}

Json ToJson(const Interval& interval) {
  return {{"value", Number(interval.value)},
          {"low", Number(interval.low)},
          {"high", Number(interval.high)}};
}

Json ToJson(const LoopLane& lane) {
  Json figures = Json::object();
  for (LoopFigure figure : kLoopFigures) {
    figure.scale = 1;
    const std::vector<double> values = Values(lane, figure);
    Json runs = Json::array();
    for (const double value : values) runs.push_back(Number(value));
    figures[figure.key] = {{"median", ToJson(MedianInterval(values))}, {"runs", runs}};
  }
  return {
      {"solver", lane.solver},
      {"effort", lane.effort},
      {"can_fall", lane.can_fall},
      {"collapsed", lane.collapsed},
      {"collapse_share", ToJson(ShareInterval(lane.collapsed, static_cast<int>(lane.runs.size())))},
      {"failures", lane.failures},
      {"figures", figures}};
}

}  // namespace

void PrintLoop(std::span<const LoopScene> scenes, const LoopOptions& options) {
  fmt::print(
      "- closed loop: each solver in a world of its own, {} frames of 1/60 s, {} seeds that "
      "displace "
      "bodies by up to 0.1 mm\n"
      "- figures: means over the second half of a run (speed: the largest); medians over seeds, "
      "and "
      "in brackets order statistics that hold the\n  true median with 95 %; collapses with "
      "Wilson's "
      "95 %; a failed run counts as infinite\n"
      "- cairn, cairn-pgs: the Bullet adapter with and without subspace steps, Budget::Time for "
      "the "
      "whole substep; bullet-si: 10 iterations\n"
      "- better: runs of the same seed with a lower figure than Bullet, and than sweeps alone with "
      "the same budget\n",
      options.frames, options.seeds);
  for (const LoopScene& scene : scenes) PrintScene(scene);
}

Json ToJson(std::span<const LoopScene> scenes, const LoopOptions& options) {
  Json list = Json::array(), budgets = Json::array();
  for (const LoopScene& scene : scenes) {
    Json lanes = Json::array();
    for (const LoopLane& lane : scene.lanes) lanes.push_back(ToJson(lane));
    list.push_back({{"scene", scene.scene.info->name},
                    {"size", scene.scene.size},
                    {"judged_by", MainFigure(scene).key},
                    {"solvers", lanes}});
  }
  for (const auto budget : options.budgets) budgets.push_back(cli::Milliseconds(budget));
  return {{"frames", options.frames},
          {"seeds", options.seeds},
          {"budgets_ms", budgets},
          {"scenes", list}};
}

}  // namespace cairn::accuracy
