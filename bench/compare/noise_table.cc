// SPDX-License-Identifier: MIT
#include "compare/noise_table.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "run/summary.h"
#include "support/statistics.h"
#include "support/text_table.h"

namespace cairn::cli {
namespace {

using Beat = Metronome::Beat;

std::vector<double> Values(const std::vector<Beat>& beats, double Beat::*part) {
  std::vector<double> values;
  for (const Beat& beat : beats) values.push_back(beat.*part);
  return values;
}

std::vector<double> TimedFrames(const SceneResult& scene, const std::vector<Frame>& frames) {
  std::vector<double> times;
  for (int i = 0; i < static_cast<int>(frames.size()); ++i) {
    if (IsTimed(scene, i)) times.push_back(frames[i].time);
  }
  return times;
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
          medians.size() < 2 || std::isnan(least)
              ? "-"
              : fmt::format("{:.1f}", 100 * (most / least - 1))};
}

/// The same for a part of the metronome.
std::vector<std::string> Row(const SceneResult& scene, const std::string& who, double Beat::*part) {
  std::vector<double> medians;
  for (const auto& beats : scene.beats) medians.push_back(Median(Values(beats, part)));
  return Row(scene.name, who, medians);
}

/// From the 10th to the 90th percentile [% of the median].
double Spread(const RunResult& run, double Beat::*part) {
  std::vector<double> all;
  for (const SceneResult& scene : run.scenes) {
    for (const auto& beats : scene.beats) {
      const std::vector<double> values = Values(beats, part);
      all.insert(all.end(), values.begin(), values.end());
    }
  }
  return 100 * (Quantile(all, 0.9) - Quantile(all, 0.1)) / Median(all);
}

}  // namespace

std::string DescribeBeats(const RunResult& run) {
  return fmt::format(
      "of the same work after each frame, 80 % took times within {:.0f} % (arithmetic) and {:.0f} "
      "% (memory)",
      Spread(run, &Beat::arithmetic), Spread(run, &Beat::memory));
}

std::string NoiseText(const RunResult& run) {
  TextTable table;
  table.columns = {{"scene", ""},   {"p50 of repetitions", ""},
                   {"least", "ms"}, {"median", "ms"},
                   {"most", "ms"},  {"spread", "%"}};
  table.names = 2;
  for (const SceneResult& scene : run.scenes) {
    table.rows.push_back(Row(scene, "metronome, arithmetic", &Beat::arithmetic));
    table.rows.push_back(Row(scene, "metronome, memory", &Beat::memory));
    for (const SolverResult& solver : scene.solvers) {
      std::vector<double> medians = {Median(TimedFrames(scene, solver.frames))};
      for (const auto& frames : solver.repeated) {
        medians.push_back(Median(TimedFrames(scene, frames)));
      }
      table.rows.push_back(Row(scene.name, solver.label, medians));
    }
  }
  return fmt::format("Noise: {}\n{}\n{}", DescribeBeats(run),
                     run.repeat > 1 ? "" : "(--repeat 5 or more shows how solvers differ)\n",
                     table.ToText());
}

}  // namespace cairn::cli
