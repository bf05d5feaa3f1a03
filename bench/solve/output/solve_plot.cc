// SPDX-License-Identifier: MIT
#include "solve/output/solve_output.h"

#include <fmt/format.h>

#include <algorithm>

#include "support/svg_plot.h"

namespace cairn::cli {
namespace {

// The panels keep the proportions of LinePlot, two in a row.
constexpr int kPanelWidth = 470, kPanelHeight = 270, kGap = 24, kLegendHeight = 34;
constexpr int kKeyWidth = 34, kLetterWidth = 7;
/// Errors from 1 to rounding.
constexpr double kDecades = 16;

constexpr std::string_view kStyle = R"css(
:root{--paper:#fdfdfc;--ink:#1d2126;--soft:#5d656e;--rule:#dde1e4}
@media (prefers-color-scheme:dark){:root{--paper:#15181b;--ink:#e9ecee;--soft:#a1aab3;--rule:#333a40}}
svg svg{width:470px;height:270px}svg svg.k{width:34px;height:12px}svg>.paper{fill:var(--paper)}
)css";

/// The same of a solver in every panel.
int StyleOf(const SolveResult& result, const std::string& label) {
  const auto found = std::find(result.solvers.begin(), result.solvers.end(), label);
  return static_cast<int>(found - result.solvers.begin());
}

LinePlot PlotOf(const SolveResult& result, const ProblemResult& problem) {
  const bool errors = problem.truth != ErrorMeter::Truth::kNone;
  LinePlot plot;
  plot.title = problem.name;
  if (errors) plot.title += ", error of " + problem.truth_name;
  plot.unit = errors ? "error" : "residual";
  if (problem.rows) {
    plot.title = problem.name + (errors ? ", velocity error" : ", residual");
    plot.unit = "m/s";
  }
  plot.x_label = "time [ms]";
  plot.most_decades = kDecades;
  for (const LcpSolverResult& solver : problem.solvers) {
    Series series{.label = solver.label, .style = StyleOf(result, solver.label), .x = {}, .y = {}};
    for (const HistoryPoint& point : solver.history) {
      series.x.push_back(point.time);
      series.y.push_back(errors ? point.error : point.residual);
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

std::string Legend(const SolveResult& result) {
  std::string svg;
  int x = kGap;
  for (size_t s = 0; s < result.solvers.size(); ++s) {
    svg += fmt::format("<svg x=\"{}\" y=\"10\" width=\"34\" height=\"12\">{}</svg>", x,
                       StyleKey(static_cast<int>(s)));
    svg += fmt::format("<text x=\"{}\" y=\"20\">{}</text>", x + kKeyWidth + 6,
                       Escape(result.solvers[s]));
    x += kKeyWidth + kGap + kLetterWidth * static_cast<int>(result.solvers[s].size());
  }
  return svg;
}

}  // namespace

std::string ToSvg(const SolveResult& result) {
  const int count = static_cast<int>(result.problems.size());
  const int columns = std::min(count, 2);
  const int width = columns * (kPanelWidth + kGap) + kGap;
  const int height = kLegendHeight + (count + columns - 1) / columns * (kPanelHeight + kGap);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\">\n<style>{2}{3}</style>\n<rect class=\"paper\" width=\"{0}\" "
      "height=\"{1}\"/>\n{4}\n",
      width, height, PlotStyleSheet(), kStyle, Legend(result));
  for (int i = 0; i < count; ++i) {
    svg += fmt::format("<svg x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\">\n{}</svg>\n",
                       kGap + i % columns * (kPanelWidth + kGap),
                       kLegendHeight + i / columns * (kPanelHeight + kGap), kPanelWidth,
                       kPanelHeight, PlotOf(result, result.problems[i]).ToSvg());
  }
  return svg + "</svg>\n";
}

}  // namespace cairn::cli
