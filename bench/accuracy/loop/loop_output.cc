// SPDX-License-Identifier: MIT
#include "accuracy/loop/loop_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/intervals.h"
#include "accuracy/paired_test.h"
#include "accuracy/report.h"
#include "frames/markdown.h"
#include "support/duration.h"
#include "support/json_number.h"

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
  frames::MarkdownTable table(columns);
  for (const LoopLane& lane : scene.lanes) {
    std::vector<std::string> cells = {lane.solver, lane.effort, Collapses(lane)};
    for (const LoopFigure& figure : kLoopFigures) cells.push_back(MedianText(lane, figure));
    table.Add(cells);
  }
  fmt::print("\n## {} (judged by {}), {} seeds\n\n", scene.scene.info->name, MainFigure(scene).name,
             scene.seeds());
  table.Print();
  for (const LoopLane& lane : scene.lanes) {
    for (const std::string& failure : lane.failures) {
      fmt::print("- {}, {}: {}\n", lane.solver, lane.effort, failure);
    }
  }
}

/// Two lanes of a scene under a budget.
struct Comparison {
  const char* name;
  Kind kind;
  std::optional<Kind> other;  ///< None: Bullet.
};
constexpr std::array kComparisons = {
    Comparison{"sweeps with Bullet", Kind::kSweeps, {}},
    Comparison{"accelerated with Bullet", Kind::kAccelerated, {}},
    Comparison{"steps with Bullet", Kind::kSteps, {}},
    Comparison{"steps with sweeps", Kind::kSteps, Kind::kSweeps},
    Comparison{"steps with accelerated", Kind::kSteps, Kind::kAccelerated}};

/// p is corrected for all scenes.
std::vector<PairedTest> Compare(std::span<const LoopScene> scenes, size_t budget,
                                const Comparison& comparison) {
  std::vector<PairedTest> tests;
  std::vector<double> p;
  for (const LoopScene& scene : scenes) {
    const LoopLane& other = comparison.other ? scene.Of(budget, *comparison.other) : scene.bullet();
    const LoopFigure& main = MainFigure(scene);
    tests.push_back(
        ComparePaired(Values(scene.Of(budget, comparison.kind), main), Values(other, main)));
    p.push_back(tests.back().p);
  }
  const std::vector<double> adjusted = HolmAdjusted(p);
  for (size_t i = 0; i < tests.size(); ++i) tests[i].p = adjusted[i];
  return tests;
}

constexpr double kLevel = 0.05;

bool IsWorse(const PairedTest& test) { return test.p < kLevel && test.more > test.less; }

std::string TestText(const PairedTest& test) {
  const char* const verdict = test.p >= kLevel ? "open" : IsWorse(test) ? "WORSE" : "better";
  return fmt::format("{} {}:{} p {}", verdict, test.less, test.more, Digits(test.p));
}

void PrintComparisons(std::span<const LoopScene> scenes, const LoopOptions& options,
                      size_t budget) {
  std::vector<std::string> columns = {"scene", "judged by"}, losses;
  std::vector<std::vector<PairedTest>> tests;
  for (const Comparison& comparison : kComparisons) {
    columns.push_back(comparison.name);
    tests.push_back(Compare(scenes, budget, comparison));
  }
  frames::MarkdownTable table(columns);
  for (size_t i = 0; i < scenes.size(); ++i) {
    const std::string name(scenes[i].scene.info->name);
    std::vector<std::string> cells = {name, MainFigure(scenes[i]).name};
    for (size_t c = 0; c < kComparisons.size(); ++c) {
      cells.push_back(TestText(tests[c][i]));
      if (IsWorse(tests[c][i])) losses.push_back(fmt::format("{}, {}", name, columns[2 + c]));
    }
    table.Add(cells);
  }
  fmt::print("\n## Compared, {}\n\n", cli::FormatDuration(options.budgets[budget]));
  table.Print();
  for (const std::string& loss : losses) fmt::print("- lost: {}\n", loss);
  if (losses.empty()) fmt::print("- lost: none\n");
}

Json ToJson(const PairedTest& test) {
  return {{"less", test.less}, {"more", test.more}, {"equal", test.equal}, {"p", Number(test.p)}};
}

Json ComparisonsToJson(std::span<const LoopScene> scenes, const LoopOptions& options) {
  Json list = Json::array();
  for (size_t budget = 0; budget < options.budgets.size(); ++budget) {
    for (const Comparison& comparison : kComparisons) {
      const std::vector<PairedTest> tests = Compare(scenes, budget, comparison);
      Json of_scenes = Json::object();
      for (size_t i = 0; i < scenes.size(); ++i) {
        of_scenes[std::string(scenes[i].scene.info->name)] = ToJson(tests[i]);
      }
      list.push_back({{"budget_ms", cli::Milliseconds(options.budgets[budget])},
                      {"compared", comparison.name},
                      {"scenes", of_scenes}});
    }
  }
  return list;
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
      "- sweeps, accelerated, steps: the Bullet adapter with sweeps alone, with accelerated "
      "sweeps, and with subspace steps (the default),\n  Budget::Time for the whole substep; "
      "bullet-si: 10 iterations, however long they take\n"
      "- compared: runs of the same seed, lower:higher figure, Wilcoxon's signed-rank test, "
      "two-sided, p corrected by Holm for all scenes;\n  open: p of {} or more\n",
      options.frames, options.seeds, kLevel);
  for (const LoopScene& scene : scenes) {
    if (scene.seeds() < options.seeds) {
      fmt::print("- stopped early: {} has {} seeds\n", scene.scene.info->name, scene.seeds());
    }
  }
  for (size_t budget = 0; budget < options.budgets.size(); ++budget) {
    PrintComparisons(scenes, options, budget);
  }
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
          {"comparisons", ComparisonsToJson(scenes, options)},
          {"scenes", list}};
}

}  // namespace cairn::accuracy
