// SPDX-License-Identifier: MIT
#include "compare/comparison.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "support/json_number.h"
#include "support/text_table.h"

namespace cairn::cli {
namespace {

using Json = nlohmann::ordered_json;

bool IsMeasured(const Change& change) { return change.verdict != Verdict::kNotMeasured; }

std::string Percent(double ratio) { return fmt::format("{:+.1f}", 100 * (ratio - 1)); }

void AddCells(const Change& change, std::string (*format)(double), std::vector<std::string>* row) {
  row->push_back(format(change.before));
  row->push_back(format(change.after));
  const bool has_interval = IsMeasured(change) && change.ratio.low > 0;
  row->push_back(IsMeasured(change) ? Percent(change.ratio.value) : "-");
  row->push_back(has_interval ? Percent(change.ratio.low) : "-");
  row->push_back(has_interval ? Percent(change.ratio.high) : "-");
  row->push_back(Describe(change.verdict));
}

TextTable LaneTable(const Comparison& comparison) {
  TextTable table;
  table.columns = {{"scene", ""},        {"solver", ""},  {"time", "old ms"}, {"", "new ms"},
                   {"change", "%"},      {"from", "%"},   {"to", "%"},        {"", ""},
                   {"error", "old m/s"}, {"", "new m/s"}, {"change", "%"},    {"from", "%"},
                   {"to", "%"},          {"", ""}};
  table.names = 2;
  for (const LaneComparison& lane : comparison.lanes) {
    std::vector<std::string>& row = table.rows.emplace_back();
    row = {lane.scene, lane.solver};
    if (!lane.failure_before.empty() || !lane.failure_after.empty()) {
      row.push_back(lane.failure_after.empty()    ? "failed before"
                    : lane.failure_before.empty() ? "FAILED"
                                                  : "failed before and after");
      continue;
    }
    AddCells(lane.time, &FormatTime, &row);
    AddCells(lane.error, &FormatNumber, &row);
  }
  return table;
}

std::string Lines(const char* head, const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += fmt::format("{}{}\n", head, sentence);
  return text;
}

Json ToJson(const Change& change) {
  if (!IsMeasured(change)) return nullptr;
  return {{"old", Number(change.before)},        {"new", Number(change.after)},
          {"ratio", Number(change.ratio.value)}, {"low", Number(change.ratio.low)},
          {"high", Number(change.ratio.high)},   {"verdict", Describe(change.verdict)}};
}

Json ToJson(const LaneComparison& lane) {
  const auto failure = [](const std::string& text) {
    return text.empty() ? Json(nullptr) : Json(text);
  };
  return {{"scene", lane.scene},
          {"solver", lane.solver},
          {"effort", lane.effort},
          {"time_ms", ToJson(lane.time)},
          {"residual_m_s", ToJson(lane.error)},
          {"failure_old", failure(lane.failure_before)},
          {"failure_new", failure(lane.failure_after)}};
}

Json ToJson(const SceneNoise& noise) {
  return {{"scene", noise.scene},
          {"old",
           {{"arithmetic_percent", Number(noise.arithmetic_before)},
            {"memory_percent", Number(noise.memory_before)}}},
          {"new",
           {{"arithmetic_percent", Number(noise.arithmetic_after)},
            {"memory_percent", Number(noise.memory_after)}}}};
}

}  // namespace

std::string ToText(const Comparison& comparison) {
  std::string text = LaneTable(comparison).ToText() + "\n";
  text += Lines("Note: ", comparison.warnings);
  text += Lines("", comparison.unknown);
  text += Lines("REGRESSION: ", comparison.regressions);
  return text + fmt::format("{} regression{}; times above {:g} %, errors above {:g} % count.\n",
                            comparison.regressions.size(),
                            comparison.regressions.size() == 1 ? "" : "s",
                            100 * comparison.thresholds.time, 100 * comparison.thresholds.error);
}

std::string ToJson(const Comparison& comparison) {
  Json lanes = Json::array(), noise = Json::array();
  for (const LaneComparison& lane : comparison.lanes) lanes.push_back(ToJson(lane));
  for (const SceneNoise& scene : comparison.noise) noise.push_back(ToJson(scene));
  const Json json = {
      {"schema_version", 1},
      {"thresholds",
       {{"time", comparison.thresholds.time}, {"error", comparison.thresholds.error}}},
      {"lanes", lanes},
      {"noise", noise},
      {"warnings", comparison.warnings},
      {"unknown", comparison.unknown},
      {"regressions", comparison.regressions}};
  return json.dump(1) + "\n";
}

}  // namespace cairn::cli
