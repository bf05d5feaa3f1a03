// SPDX-License-Identifier: MIT
#include "page/page_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "support/duration.h"
#include "support/statistics.h"
#include "support/svg_plot.h"

namespace cairn::cli {
namespace {

template <class Value>
LinePlot OverFrames(const SceneResult& scene, std::string title, std::string unit, Value value) {
  LinePlot plot;
  plot.title = std::move(title);
  plot.unit = std::move(unit);
  for (size_t s = 0; s < scene.solvers.size(); ++s) {
    const SolverResult& solver = scene.solvers[s];
    Series series{.label = solver.label, .style = static_cast<int>(s), .x = {}, .y = {}};
    for (size_t i = 0; i < solver.frames.size(); ++i) {
      const double y = value(solver.frames[i]);
      if (std::isnan(y)) continue;
      series.x.push_back(static_cast<double>(i));
      series.y.push_back(y);
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

std::string Figure(const std::string& svg) { return "<figure>" + svg + "</figure>\n"; }

/// Medians over the samples, rung by rung.
Series MedianCurve(const SolverResult& solver, int style) {
  Series series{.label = solver.label, .style = style, .x = {}, .y = {}};
  size_t rungs = 0;
  for (const auto& curve : solver.curves) rungs = std::max(rungs, curve.size());
  for (size_t rung = 0; rung < rungs; ++rung) {
    std::vector<double> times, errors;
    for (const auto& curve : solver.curves) {
      if (rung >= curve.size()) continue;
      times.push_back(curve[rung].time);
      errors.push_back(curve[rung].error);
    }
    // less effort that took longer says nothing
    const double time = Median(times);
    while (!series.x.empty() && series.x.back() >= time) {
      series.x.pop_back();
      series.y.pop_back();
    }
    series.x.push_back(time);
    series.y.push_back(Median(errors));
  }
  return series;
}

}  // namespace

std::string TimePlot(const SceneResult& scene, const RunResult& run) {
  LinePlot plot =
      OverFrames(scene, "Time in the solver", "ms", [](const Frame& f) { return f.time; });
  plot.x_most = run.frames;
  if (run.budget) {
    plot.limit = Milliseconds(*run.budget);
    plot.limit_label = "budget " + FormatDuration(*run.budget);
  }
  return Figure(plot.ToSvg());
}

std::string ResidualPlot(const SceneResult& scene, const RunResult& run) {
  LinePlot plot = OverFrames(scene, "Residual, in the own run of each", "m/s",
                             [](const Frame& f) { return f.residual; });
  plot.x_most = run.frames;
  return Figure(plot.ToSvg());
}

std::string ErrorTimePlot(const SceneResult& scene) {
  LinePlot plot;
  plot.title = "Velocity error on the same states, medians";
  plot.unit = "m/s";
  plot.x_scale = LinePlot::Scale::kLogarithmic;
  plot.x_label = "solver time [ms]";
  for (size_t s = 0; s < scene.solvers.size(); ++s) {
    plot.series.push_back(MedianCurve(scene.solvers[s], static_cast<int>(s)));
  }
  return Figure(plot.ToSvg());
}

std::string FactBars(const SceneResult& scene) {
  size_t facts = 0;
  for (const SolverResult& solver : scene.solvers) facts = std::max(facts, solver.facts.size());
  std::string html;
  for (size_t f = 0; f < facts; ++f) {
    BarChart chart;
    for (size_t s = 0; s < scene.solvers.size(); ++s) {
      const SolverResult& solver = scene.solvers[s];
      const bool known = f < solver.facts.size();
      if (known) chart.title = fmt::format("{} [{}]", solver.facts[f].name, solver.facts[f].unit);
      chart.bars.push_back(
          {solver.label, static_cast<int>(s), known ? solver.facts[f].value : kNotMeasured});
    }
    const bool any = std::any_of(chart.bars.begin(), chart.bars.end(),
                                 [](const BarChart::Bar& bar) { return !std::isnan(bar.value); });
    if (any) html += Figure(chart.ToSvg());
  }
  return html;
}

}  // namespace cairn::cli
