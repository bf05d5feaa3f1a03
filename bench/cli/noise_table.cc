// SPDX-License-Identifier: MIT
#include "cli/noise_table.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "cli/statistics.h"
#include "cli/summary.h"
#include "cli/text_table.h"

namespace cairn::cli {
namespace {

std::string Percent(double share) { return fmt::format("{:.1f}", 100 * share); }

double TimedMedian(const SceneResult& scene, const std::vector<Frame>& frames) {
  std::vector<double> times;
  for (int i = 0; i < static_cast<int>(frames.size()); ++i) {
    if (IsTimed(scene, i)) times.push_back(frames[i].time);
  }
  return Median(times);
}

/// A row of the table: the medians of repetitions and how far they are apart.
std::vector<std::string> Row(const std::string& scene, const std::string& who,
                             const std::vector<double>& medians) {
  const double least = Quantile(medians, 0), most = Largest(medians);
  return {scene,
          who,
          FormatTime(least),
          FormatTime(Median(medians)),
          FormatTime(most),
          medians.size() < 2 || std::isnan(least) ? "-" : Percent(most / least - 1)};
}

}  // namespace

std::string DescribeBeats(const RunResult& run) {
  std::vector<double> all;
  for (const SceneResult& scene : run.scenes) {
    for (const auto& beats : scene.beats) all.insert(all.end(), beats.begin(), beats.end());
  }
  const double median = Median(all);
  return fmt::format(
      "the same {:.3f} ms of work after each frame (metronome): 80 % of {} times within {} %, p99 "
      "{:.2f} of the median",
      median, all.size(), Percent((Quantile(all, 0.9) - Quantile(all, 0.1)) / median),
      Quantile(all, 0.99) / median);
}

std::string NoiseText(const RunResult& run) {
  TextTable table;
  table.columns = {{"scene", ""},   {"p50 of repetitions", ""},
                   {"least", "ms"}, {"median", "ms"},
                   {"most", "ms"},  {"spread", "%"}};
  table.names = 2;
  for (const SceneResult& scene : run.scenes) {
    std::vector<double> medians;
    for (const auto& beats : scene.beats) medians.push_back(Median(beats));
    table.rows.push_back(Row(scene.name, "metronome", medians));
    for (const SolverResult& solver : scene.solvers) {
      medians = {TimedMedian(scene, solver.frames)};
      for (const auto& frames : solver.repeated) medians.push_back(TimedMedian(scene, frames));
      table.rows.push_back(Row(scene.name, solver.label, medians));
    }
  }
  return fmt::format("Noise: {}{}\n\n{}", DescribeBeats(run),
                     run.repeat > 1 ? "" : "\n(--repeat 5 or more shows how solvers differ)",
                     table.ToText());
}

}  // namespace cairn::cli
