// SPDX-License-Identifier: MIT
#include "page/html_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include "compare/noise_table.h"
#include "page/page_parts.h"
#include "run/output/run_output.h"
#include "support/svg_plot.h"
#include "support/text_table.h"

namespace cairn::cli {
namespace {

std::string Entry(std::string_view name, const std::string& value) {
  return fmt::format("<dt>{}</dt><dd>{}</dd>\n", name, Escape(value));
}

/// The least and the most in the frames of a solver.
std::string Range(const SolverResult& solver, int (*count)(const Frame&)) {
  std::vector<int> counts;
  for (const Frame& frame : solver.frames) {
    if (count(frame) > 0) counts.push_back(count(frame));
  }
  if (counts.empty()) return "0";
  const auto [least, most] = std::minmax_element(counts.begin(), counts.end());
  return *least == *most ? fmt::format("{}", *most) : fmt::format("{} to {}", *least, *most);
}

/// What makes the times of this run doubtful.
std::vector<std::string> Warnings(const RunResult& run) {
  std::vector<std::string> warnings;
  double load = 0;
  const std::string& text = run.machine.load_average;
  std::from_chars(text.data(), text.data() + text.size(), load);
  if (load > 0.5 * run.machine.cores) {
    warnings.push_back(
        fmt::format("The machine was busy: load {:.1f} on {} cores.", load, run.machine.cores));
  }
  if (run.noise.p99_over_median > 1.2) {
    warnings.push_back(fmt::format("The same work took up to {:.1f} times its usual time.",
                                   run.noise.p99_over_median));
  }
  if (run.machine.governor.empty()) {
    warnings.push_back("The system does not say whether the clock of the processor is fixed.");
  } else if (run.machine.governor != "performance") {
    warnings.push_back("The clock of the processor may change: governor " + run.machine.governor +
                       ".");
  }
  if (run.build.build_type != "Release") {
    warnings.push_back("Not a release build: " + run.build.build_type + ".");
  }
  if (!run.setup.pinned) warnings.push_back("Threads were not pinned to cores.");
  return warnings;
}

std::string List(const std::vector<std::string>& lines) {
  std::string html = "<ul>";
  for (const std::string& line : lines) html += "<li>" + Escape(line) + "</li>";
  return html + "</ul>";
}

}  // namespace

std::string ProblemCard(const SceneResult& scene) {
  const auto source = std::find_if(scene.solvers.begin(), scene.solvers.end(),
                                   [](const SolverResult& solver) { return !solver.failure; });
  const SolverResult& solver = source == scene.solvers.end() ? scene.solvers.front() : *source;
  std::string html = "<section class=\"card\"><h3>The problem</h3><dl>\n";
  html += Entry("Scene", scene.description);
  html += Entry("Bodies", fmt::format("{}", scene.bodies));
  html += Entry("Contacts",
                Range(solver, [](const Frame& f) { return f.facts.contacts; }) + " points a frame");
  html += Entry("Joints", fmt::format("{}", scene.joints));
  html += Entry("Rows", Range(solver, [](const Frame& f) { return f.rows; }));
  html += Entry("Islands", Range(solver, [](const Frame& f) { return f.islands; }));
  html += Entry("Mass ratio", FormatNumber(scene.mass_ratio));
  html += Entry("Seen in", "the run of " + solver.label);
  return html + "</dl></section>\n";
}

std::string MethodBox(const RunResult& run) {
  std::string html = "<section class=\"card\"><h2>Method</h2><dl>\n";
  html += fmt::format("<dt>Command</dt><dd><code>{}</code></dd>\n", Escape(run.command));
  html += Entry("Date", run.date);
  html += Entry(
      "Machine",
      fmt::format(
          "{}, {} cores, {}; load {}; {} instructions in force", run.machine.cpu, run.machine.cores,
          run.machine.governor.empty() ? "governor unknown" : "governor " + run.machine.governor,
          run.machine.load_average, run.simd_target));
  html += Entry("Run", DescribeRun(run));
  html += Entry("Noise", run.noise.verdict + "; " + DescribeBeats(run));
  html += "<dt>Warnings</dt><dd>" + List(Warnings(run)) + "</dd>\n";
  html += Entry("Cairn", fmt::format("{}, {}, {}", run.build.version, run.build.compiler,
                                     run.build.build_type));
  html += Entry("Bullet", DescribeBullet(run.build));
  html += Entry("Order",
                "Each solver has a world of its own; the worlds step in turn, frame by frame. "
                "Frames in which states are sampled, and those before, are not timed.");
  html += Entry("Definitions", ReadingHelp(run));
  html += PageScript().empty()
              ? Entry("Page",
                      "Without scripts: the tool was built without Node, or without a "
                      "network. No replay.")
              : Entry("Page",
                      "Pictures by uPlot, replay by three.js, both under the MIT licence; "
                      "their notices are in the source of this page.");
  return html + "</dl></section>\n";
}

}  // namespace cairn::cli
