// SPDX-License-Identifier: MIT
#include "cli/html_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "cli/duration.h"
#include "cli/run_tables.h"
#include "cli/summary.h"
#include "cli/svg_plot.h"

namespace cairn::cli {
namespace {

constexpr std::string_view kStyle = R"css(
:root{color-scheme:light dark;--paper:#fdfdfc;--ink:#1d2126;--soft:#5d656e;--rule:#dde1e4;--card:#f3f5f6;--bad:#a32020}
@media (prefers-color-scheme:dark){:root{--paper:#15181b;--ink:#e9ecee;--soft:#a1aab3;--rule:#333a40;--card:#1e2327;--bad:#ff8f86}}
@media print{:root{--paper:#fff;--ink:#000;--soft:#333;--rule:#bbb;--card:#fff;--bad:#700}.card{border:1px solid #bbb}}
body{margin:0 auto;max-width:1020px;padding:28px 22px 60px;background:var(--paper);color:var(--ink);font:15px/1.5 system-ui,sans-serif}
h1{font-size:22px;margin:0}h2{font-size:18px;margin:38px 0 4px}h3{font-size:14px;margin:22px 0 4px}
p{margin:6px 0}.soft{color:var(--soft);font-size:13px}.verdict{font-size:17px;margin:12px 0 14px;max-width:60em}
.wide{overflow-x:auto}table{border-collapse:collapse;font-size:13.5px;width:100%;font-variant-numeric:tabular-nums}
th,td{padding:5px 8px;text-align:right;border-bottom:1px solid var(--rule);white-space:nowrap}
th{font-weight:600;vertical-align:bottom;line-height:1.25}th small{display:block;font-weight:400;color:var(--soft)}
th:first-child,td:first-child{text-align:left}td.remark{text-align:left;color:var(--bad);white-space:normal}
.plots{display:grid;grid-template-columns:repeat(auto-fit,minmax(380px,1fr));gap:18px 26px;margin:20px 0}
.bars{display:grid;grid-template-columns:repeat(auto-fit,minmax(225px,1fr));gap:12px 22px;margin:14px 0}
figure{margin:0;break-inside:avoid}.card{background:var(--card);border-radius:8px;padding:12px 18px;margin-top:36px;font-size:13.5px}
.card h2{margin:4px 0 8px;font-size:16px}dl{display:grid;grid-template-columns:9em 1fr;gap:4px 14px;margin:0}
dt{color:var(--soft)}dd{margin:0;overflow-wrap:anywhere}code{font:12.5px ui-monospace,monospace}
.legend{display:flex;flex-wrap:wrap;gap:4px 20px;font-size:13px;margin-top:16px}
)css";

std::string Table(const TextTable& table, const SceneResult& scene) {
  std::string html = "<div class=\"wide\"><table><thead><tr>";
  for (const TextTable::Column& column : table.columns) {
    html += fmt::format("<th>{}<small>{}</small></th>", Escape(column.name), Escape(column.unit));
  }
  html += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (size_t i = 0; i < row.size(); ++i) {
      if (row.size() < table.columns.size() && i + 1 == row.size()) {
        html += fmt::format("<td class=\"remark\" colspan=\"{}\">{}</td>", table.columns.size() - i,
                            Escape(row[i]));
        continue;
      }
      std::string key;
      for (size_t s = 0; i == 0 && s < scene.solvers.size(); ++s) {
        if (scene.solvers[s].label == row[0]) key = StyleKey(static_cast<int>(s));
      }
      html += fmt::format("<td>{}{}</td>", key, Escape(row[i]));
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

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

LinePlot ErrorsAtSamples(const SceneResult& scene) {
  LinePlot plot;
  plot.title = "Velocity error on the same states";
  plot.unit = "m/s";
  for (size_t s = 0; s < scene.solvers.size(); ++s) {
    Series series{.label = scene.solvers[s].label, .style = static_cast<int>(s), .x = {}, .y = {}};
    for (size_t i = 0; i < scene.samples.size(); ++i) {
      series.x.push_back(scene.samples[i].frame);
      series.y.push_back(scene.solvers[s].velocity_errors[i]);
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

std::string Bars(const SceneResult& scene) {
  size_t facts = 0;
  for (const SolverResult& solver : scene.solvers) facts = std::max(facts, solver.facts.size());
  std::string html = "<div class=\"bars\">";
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
    if (any) html += "<figure>" + chart.ToSvg() + "</figure>";
  }
  return html + "</div>\n";
}

std::string Legend(const SceneResult& scene) {
  std::string html = "<div class=\"legend\">";
  for (size_t s = 0; s < scene.solvers.size(); ++s) {
    html += fmt::format("<span>{}{} <span class=\"soft\">{}</span></span>",
                        StyleKey(static_cast<int>(s)), Escape(scene.solvers[s].label),
                        Escape(scene.solvers[s].effort));
  }
  return html + "</div>\n";
}

std::string Section(const SceneResult& scene, const RunResult& run) {
  LinePlot time =
      OverFrames(scene, "Time in the solver", "ms", [](const Frame& f) { return f.time; });
  if (run.budget) {
    time.limit = Milliseconds(*run.budget);
    time.limit_label = "budget " + FormatDuration(*run.budget);
  }
  LinePlot residual = OverFrames(scene, "Residual, in the own run of each", "m/s",
                                 [](const Frame& f) { return f.residual; });
  time.x_most = residual.x_most = run.frames;
  std::string html = fmt::format("<h2>{}</h2><p class=\"soft\">{}</p><p class=\"verdict\">{}</p>\n",
                                 Escape(scene.name), Escape(SceneHeading(scene, run)),
                                 Escape(Verdict(scene, run)));
  html += Table(PerformanceTable(scene, run), scene) + Legend(scene);
  html += "<div class=\"plots\"><figure>" + time.ToSvg() + "</figure><figure>" + residual.ToSvg() +
          "</figure>";
  if (!scene.samples.empty()) {
    LinePlot errors = ErrorsAtSamples(scene);
    errors.x_most = run.frames;
    html += "<figure>" + errors.ToSvg() + "</figure>";
  }
  html += "</div>\n<h3>What became of the scene</h3>\n" + Table(FactsTable(scene, run), scene);
  return html + Bars(scene);
}

std::string MethodBox(const RunResult& run) {
  const auto entry = [](std::string_view name, const std::string& value) {
    return fmt::format("<dt>{}</dt><dd>{}</dd>\n", name, Escape(value));
  };
  std::string html = "<section class=\"card\"><h2>Method</h2><dl>\n";
  html += fmt::format("<dt>Command</dt><dd><code>{}</code></dd>\n", Escape(run.command));
  html += entry("Date", run.date);
  html += entry("Machine",
                fmt::format("{}, {} cores, {}; load {}", run.machine.cpu, run.machine.cores,
                            run.machine.governor.empty() ? "governor unknown"
                                                         : "governor " + run.machine.governor,
                            run.machine.load_average));
  html += entry("Noise", run.noise.verdict);
  html += entry("Cairn", fmt::format("{}, {}, {}", run.build.version, run.build.compiler,
                                     run.build.build_type));
  html += entry("Bullet", DescribeBullet(run.build));
  html += entry("Order",
                "Each solver has a world of its own; the worlds step in turn, frame by frame.");
  html += entry("Definitions", ReadingHelp(run));
  return html + "</dl></section>\n";
}

}  // namespace

std::string ToHtml(const RunResult& run) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>Cairn: frame-budget report</title>\n<style>{}{}</style></head><body>\n"
      "<h1>Frame-budget report</h1><p class=\"soft\">{}</p>\n",
      kStyle, PlotStyleSheet(), Escape(run.date));
  for (const SceneResult& scene : run.scenes) html += Section(scene, run);
  return html + MethodBox(run) + "</body></html>\n";
}

}  // namespace cairn::cli
