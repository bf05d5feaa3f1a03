// SPDX-License-Identifier: MIT
#include "page/html_report.h"

#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "page/page_parts.h"
#include "run/output/run_output.h"
#include "run/summary.h"
#include "support/statistics.h"
#include "support/svg_plot.h"

namespace cairn::cli {
namespace {

std::string Table(const TextTable& table, const SceneResult& scene, std::string_view kind = "") {
  std::string html = fmt::format("<div class=\"wide\"><table class=\"{}\"><thead><tr>", kind);
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

std::string Legend(const SceneResult& scene) {
  std::string html = "<div class=\"legend\">";
  for (size_t s = 0; s < scene.solvers.size(); ++s) {
    html += fmt::format("<span>{}{} <span class=\"soft\">{}</span></span>",
                        StyleKey(static_cast<int>(s)), Escape(scene.solvers[s].label),
                        Escape(scene.solvers[s].effort));
  }
  return html + "</div>\n";
}

/// A place that a script fills, and what stands there without scripts.
std::string Plot(std::string_view name, size_t scene, const std::string& without_scripts = "") {
  const std::string fallback =
      without_scripts.empty() ? "" : "<div class=\"static\">" + without_scripts + "</div>";
  return fallback +
         fmt::format("<div class=\"scripted\" data-plot=\"{}\" data-scene=\"{}\"></div>\n", name,
                     scene);
}

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

/// Error against time for a page without scripts.
std::string ErrorTimePlot(const SceneResult& scene) {
  LinePlot plot;
  plot.title = "Velocity error on the same states, medians";
  plot.unit = "m/s";
  plot.x_label = "solver time [ms]";
  for (size_t s = 0; s < scene.solvers.size(); ++s) {
    plot.series.push_back(MedianCurve(scene.solvers[s], static_cast<int>(s)));
  }
  return "<figure>" + plot.ToSvg() + "</figure>\n";
}

std::string Errors(const SceneResult& scene, const RunResult& run, size_t index) {
  if (scene.samples.empty()) {
    return "<h3>Error against time</h3><p class=\"soft\">Not measured in this run: it took no "
           "samples.</p>\n";
  }
  return "<h3>Error against time</h3>\n<p class=\"soft\">Largest body velocity error against a "
         "converged reference. Every solver was given the same states of the run, with more and "
         "more to spend: iterations, or a budget.</p>\n" +
         Plot("error-time", index, ErrorTimePlot(scene)) +
         "<h3>Error at fixed budgets</h3>\n<p class=\"soft\">Median over the states of the best "
         "effort that took no longer; - where none was that quick on all of them.</p>\n" +
         Table(BudgetTable(scene, run), scene, "narrow") +
         "<div class=\"scripted\"><h3>Performance profile</h3>\n<p class=\"soft\">Share of the "
         "states on which a solver got below an error within a multiple of the time of the "
         "quickest one: higher and further left is better, and what it never reached is missing on "
         "the right.</p></div>\n" +
         Plot("profile", index);
}

std::string Section(const SceneResult& scene, const RunResult& run, size_t index) {
  std::string html = fmt::format(
      "<section>\n<h2>{}</h2><p class=\"soft\">{}</p><p class=\"verdict\">{}</p><p>{}</p>\n",
      Escape(scene.name), Escape(SceneHeading(scene, run)), Escape(Advice(scene, run)),
      Escape(Verdict(scene, run)));
  html += Table(PerformanceTable(scene, run), scene) + Legend(scene);
  html += Errors(scene, run, index);
  html += "<div class=\"scripted\"><h3>Frame times</h3></div>\n" + Plot("histogram", index) +
          Plot("strip", index);
  html += "<div class=\"scripted\"><h3>Replay</h3></div>\n" + Plot("replay", index);
  html +=
      "<div class=\"scripted\"><h3>Inside the slowest frame</h3></div>\n" + Plot("timeline", index);
  html += "<h3>What became of the scene</h3>\n" + Table(FactsTable(scene, run), scene) +
          Plot("facts", index);
  return html + ProblemCard(scene) + "</section>\n";
}

/// What time depends on.
std::string ScalingSection(const RunResult& run) {
  std::string html = "<section>\n<h2>Scaling</h2>\n";
  const TextTable table = ScalingTable(run);
  if (table.rows.empty()) {
    html +=
        "<p class=\"soft\">Threads and instruction sets: not measured, as no solver of Cairn "
        "was in this run.</p>\n";
  } else {
    html +=
        "<p class=\"soft\">Ten plain sweeps of Cairn on the last frame, set-up included, by "
        "threads (best instruction set) and by instruction set (one thread).</p>\n" +
        Table(table, run.scenes.front()) + "<div class=\"scripted\"><div class=\"legend\">";
    const std::vector<std::string> names = ScalingNames(run);
    for (size_t i = 0; i < names.size(); ++i) {
      html += fmt::format("<span>{}{}</span>", StyleKey(static_cast<int>(i)), Escape(names[i]));
    }
    html += "</div></div>\n";
  }
  return html + "<div class=\"scripted\" data-plot=\"scaling\"></div>\n</section>\n";
}

}  // namespace

std::string ToHtml(const RunResult& run) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>Cairn: frame-budget report</title>\n<style>{}{}</style></head><body>\n"
      "<h1>Frame-budget report</h1><p class=\"soft\">{}</p>\n",
      PageStyle(), PlotStyleSheet(), Escape(run.date));
  for (size_t i = 0; i < run.scenes.size(); ++i) html += Section(run.scenes[i], run, i);
  html += ScalingSection(run) + MethodBox(run);
  if (!PageScript().empty()) {
    html += fmt::format(
        "<script type=\"application/json\" id=\"data\">{}</script>\n<script>{}</script>\n",
        PageData(run), PageScript());
  }
  return html + "</body></html>\n";
}

}  // namespace cairn::cli
