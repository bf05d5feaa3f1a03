// SPDX-License-Identifier: MIT
#include "run/output/run_output.h"

#include <fmt/format.h>

#include <algorithm>

#include "support/text_table.h"

namespace cairn::cli {
namespace {

const SceneResult* FirstMeasured(const RunResult& run) {
  const auto scene = std::find_if(run.scenes.begin(), run.scenes.end(),
                                  [](const SceneResult& s) { return s.scaling.has_value(); });
  return scene == run.scenes.end() ? nullptr : &*scene;
}

}  // namespace

std::vector<std::string> ScalingNames(const RunResult& run) {
  std::vector<std::string> names;
  const SceneResult* const scene = FirstMeasured(run);
  if (scene == nullptr) return names;
  for (const Scaling::Timing& timing : scene->scaling->threads) {
    names.push_back(timing.name + (timing.name == "1" ? " thread" : " threads"));
  }
  for (const Scaling::Timing& timing : scene->scaling->targets) names.push_back(timing.name);
  return names;
}

TextTable ScalingTable(const RunResult& run) {
  TextTable table;
  if (FirstMeasured(run) == nullptr) return table;
  table.columns = {{"scene", ""}, {"rows", ""}};
  for (const std::string& name : ScalingNames(run)) table.columns.push_back({name, "ns a row"});
  for (const SceneResult& scene : run.scenes) {
    if (!scene.scaling) continue;
    std::vector<std::string> row = {scene.name, fmt::format("{}", scene.scaling->rows)};
    const auto add = [&](const Scaling::Timing& timing) {
      row.push_back(FormatNumber(1e6 * timing.time / scene.scaling->rows));
    };
    std::for_each(scene.scaling->threads.begin(), scene.scaling->threads.end(), add);
    std::for_each(scene.scaling->targets.begin(), scene.scaling->targets.end(), add);
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace cairn::cli
