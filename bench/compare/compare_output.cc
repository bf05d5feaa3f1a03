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

TextTable SolverTable(const Comparison& comparison) {
  TextTable table;
  table.columns = {{"scene", ""},        {"solver", ""},  {"time", "old ms"}, {"", "new ms"},
                   {"change", "%"},      {"from", "%"},   {"to", "%"},        {"", ""},
                   {"error", "old m/s"}, {"", "new m/s"}, {"change", "%"},    {"from", "%"},
                   {"to", "%"},          {"", ""}};
  table.names = 2;
  for (const SolverComparison& solver : comparison.solvers) {
    std::vector<std::string>& row = table.rows.emplace_back();
    row = {solver.scene, solver.name};
    if (!solver.failure_before.empty() || !solver.failure_after.empty()) {
      row.push_back(solver.failure_after.empty()    ? "failed before"
                    : solver.failure_before.empty() ? "FAILED"
                                                    : "failed before and after");
      continue;
    }
    AddCells(solver.time, &FormatTime, &row);
    AddCells(solver.error, &FormatNumber, &row);
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

Json ToJson(const SolverComparison& solver) {
  const auto failure = [](const std::string& text) {
    return text.empty() ? Json(nullptr) : Json(text);
  };
  return {{"scene", solver.scene},
          {"solver", solver.name},
          {"effort", solver.effort},
          {"time_ms", ToJson(solver.time)},
          {"residual_m_s", ToJson(solver.error)},
          {"failure_old", failure(solver.failure_before)},
          {"failure_new", failure(solver.failure_after)}};
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
  std::string text = SolverTable(comparison).ToText() + "\n";
  text += Lines("Note: ", comparison.warnings);
  text += Lines("", comparison.unknown);
  text += Lines("REGRESSION: ", comparison.regressions);
  return text + fmt::format("{} regression{}; times above {:g} %, errors above {:g} % count.\n",
                            comparison.regressions.size(),
                            comparison.regressions.size() == 1 ? "" : "s",
                            100 * comparison.thresholds.time, 100 * comparison.thresholds.error);
}

std::string ToJson(const Comparison& comparison) {
  Json solvers = Json::array(), noise = Json::array();
  for (const SolverComparison& solver : comparison.solvers) solvers.push_back(ToJson(solver));
  for (const SceneNoise& scene : comparison.noise) noise.push_back(ToJson(scene));
  const Json json = {
      {"schema_version", 1},
      {"thresholds",
       {{"time", comparison.thresholds.time}, {"error", comparison.thresholds.error}}},
      {"lanes", solvers},
      {"noise", noise},
      {"warnings", comparison.warnings},
      {"unknown", comparison.unknown},
      {"regressions", comparison.regressions}};
  return json.dump(1) + "\n";
}

}  // namespace cairn::cli
