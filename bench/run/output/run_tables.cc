// SPDX-License-Identifier: MIT
#include "run/output/run_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "run/summary.h"
#include "support/duration.h"

namespace cairn::cli {
namespace {

std::string FailureText(const SolverResult& solver) {
  return fmt::format("FAILED at frame {}: {}", solver.failure->frame, solver.failure->reason);
}

/// Indices of the facts that the scene has for any solver.
std::vector<size_t> KnownFacts(const SceneResult& scene) {
  std::vector<size_t> known;
  for (const SolverResult& solver : scene.solvers) {
    for (size_t i = 0; i < solver.facts.size(); ++i) {
      const bool is_new = std::find(known.begin(), known.end(), i) == known.end();
      if (is_new && !std::isnan(solver.facts[i].value)) known.push_back(i);
    }
  }
  std::sort(known.begin(), known.end());
  return known;
}

const Fact& NameOf(size_t fact, const SceneResult& scene) {
  return std::find_if(scene.solvers.begin(), scene.solvers.end(),
                      [fact](const SolverResult& s) { return fact < s.facts.size(); })
      ->facts[fact];
}

bool AnySolver(const SceneResult& scene, bool (*has)(const SolverResult&)) {
  return std::any_of(scene.solvers.begin(), scene.solvers.end(), has);
}

bool CanFall(const SolverResult& solver) { return solver.standing.has_value(); }

std::string SampleSources(const RunResult& run) {
  std::vector<std::string> labels;
  for (const SceneResult& scene : run.scenes) {
    for (const Sample& sample : scene.samples) {
      if (std::find(labels.begin(), labels.end(), sample.source) == labels.end()) {
        labels.push_back(sample.source);
      }
    }
  }
  return fmt::format("{}", fmt::join(labels, ", "));
}

}  // namespace

TextTable PerformanceTable(const SceneResult& scene, const RunResult& run) {
  TextTable table;
  table.columns = {{"solver", ""},          {"p50", "ms"},
                   {"p99", "ms"},           {"p99.9", "ms"},
                   {"max", "ms"},           {"over budget", ""},
                   {"sweeps", "/frame"},    {"residual", "mean m/s"},
                   {"residual", "max m/s"}, {"v error", "median m/s"},
                   {"v error", "max m/s"}};
  for (const SolverResult& solver : scene.solvers) {
    const Summary s = Summarise(solver, scene, run.budget);
    if (solver.failure && s.timed_frames < 2) {
      table.rows.push_back({solver.label, FailureText(solver)});
      continue;
    }
    table.rows.push_back({solver.label, FormatTime(s.p50), FormatTime(s.p99), FormatTime(s.p999),
                          FormatTime(s.max), FormatOverruns(s),
                          solver.counts_iterations ? fmt::format("{:.1f}", s.iterations) : "direct",
                          FormatNumber(s.residual_mean), FormatNumber(s.residual_max),
                          FormatNumber(s.error_median), FormatNumber(s.error_max)});
    if (solver.failure) table.rows.push_back({"", FailureText(solver)});
  }
  return table;
}

TextTable FactsTable(const SceneResult& scene, const RunResult& run) {
  const std::vector<size_t> facts = KnownFacts(scene);
  const bool can_fall = AnySolver(scene, CanFall);
  TextTable table;
  table.columns = {{"at the end", ""}};
  for (size_t i : facts) table.columns.push_back({NameOf(i, scene).name, NameOf(i, scene).unit});
  if (can_fall) table.columns.push_back({"scene", ""});
  table.columns.push_back({"steps kept", "/undone"});
  table.columns.push_back({"factorised", "times"});
  table.columns.push_back({"guarded", "islands"});
  table.columns.push_back({"fallbacks", "% of calls"});
  for (const SolverResult& solver : scene.solvers) {
    const Summary s = Summarise(solver, scene, run.budget);
    std::vector<std::string>& row = table.rows.emplace_back();
    row.push_back(solver.label);
    if (solver.failure) {
      row.push_back(fmt::format("failed at frame {}", solver.failure->frame));
      continue;
    }
    for (size_t i : facts) row.push_back(FormatNumber(solver.facts[i].value));
    if (can_fall) row.push_back(!solver.standing ? "-" : *solver.standing ? "standing" : "fallen");
    row.push_back(solver.is_ours ? fmt::format("{}/{}", s.steps_accepted, s.steps_restored) : "-");
    row.push_back(solver.is_ours ? fmt::format("{}", s.factorisations) : "-");
    row.push_back(solver.is_ours ? fmt::format("{}", s.guarded) : "-");
    row.push_back(solver.fallback_share ? fmt::format("{:.0f}", 100 * *solver.fallback_share)
                                        : "-");
  }
  return table;
}

std::string SceneHeading(const SceneResult& scene, const RunResult& run) {
  return fmt::format("{}, size {}, seed {}: {} bodies, {} joints, {}{} frames of 1/60 s, {}",
                     scene.name, scene.size, scene.seed, scene.bodies, scene.joints,
                     scene.friction_directions == 1 ? "friction in 1 direction, " : "", run.frames,
                     run.budget || run.units
                         ? fmt::format("budget {} a frame", FormatBudget({run.budget, run.units}))
                         : std::string("no budget"));
}

std::string DescribeRun(const RunResult& run) {
  return fmt::format(
      "{} frames, {}, {};\n{}; {} instructions{}", run.frames,
      run.warmup == 0 ? std::string("all of which count")
                      : fmt::format("the first {} of which do not count", run.warmup),
      run.repeat == 1 ? std::string("once")
                      : fmt::format("{} times (times and residuals are of all)", run.repeat),
      Describe(run.setup), run.simd_target, run.setup.simd.empty() ? "" : " by request");
}

std::string ReadingHelp(const RunResult& run) {
  std::string help =
      "p50, p99, p99.9, max: time in the solver per frame, set-up and write-back included; the "
      "collision\n"
      "detection of Bullet is not. residual: how far the worst row is from its law (contact,\n"
      "friction or joint), mean and maximum over frames";
  const auto [least, most] = std::minmax_element(
      run.scenes.begin(), run.scenes.end(),
      [](const auto& a, const auto& b) { return a.observed_every < b.observed_every; });
  if (most->observed_every > 1) {
    help += fmt::format(" (every {}{}th)",
                        least->observed_every == most->observed_every ? "" : "one or every ",
                        most->observed_every);
  }
  help += ".\n";
  if (const std::string sources = SampleSources(run); !sources.empty()) {
    help += fmt::format(
        "v error: largest body velocity error against a converged reference, all solvers given "
        "the\n"
        "same states, which are from the run of {}, and contacts that are not made gentle with "
        "age.\n",
        sources);
  }
  help +=
      "steps: those that solve for many rows at once, kept or taken back; factorised: how many "
      "matrices\n"
      "for them. guarded: islands whose step or impulses put energy in and were undone or made "
      "smaller.\n"
      "fallbacks: substeps that Cairn refused and left to Bullet's own solver.\n";
  for (const SceneResult& scene : run.scenes) {
    for (const Sample& sample : scene.samples) {
      if (sample.reference_residual > 1e-5) {
        help += fmt::format(
            "On {} the reference itself has a residual of {} m/s (median): small errors there say "
            "little.\n",
            scene.name, FormatNumber(ReferenceResidual(scene)));
        break;
      }
    }
  }
  help += fmt::format("Compared with {}.\nMachine: {}, {}.\nRun: {}.\n", DescribeBullet(run.build),
                      run.machine.cpu, run.noise.verdict, DescribeRun(run));
  return help;
}

std::string ToText(const RunResult& run) {
  std::string text;
  for (const SceneResult& scene : run.scenes) {
    text += SceneHeading(scene, run) + "\n\n" + PerformanceTable(scene, run).ToText() + "\n" +
            FactsTable(scene, run).ToText() + "\n";
  }
  return text;
}

std::string ToMarkdown(const RunResult& run) {
  std::string text;
  for (const SceneResult& scene : run.scenes) {
    text += "## " + SceneHeading(scene, run) + "\n\n" + Verdict(scene, run) + "\n\n" +
            PerformanceTable(scene, run).ToMarkdown() + "\n" + FactsTable(scene, run).ToMarkdown() +
            "\n";
  }
  return text + ReadingHelp(run) + fmt::format("\nCommand: `{}`\n", run.command);
}

}  // namespace cairn::cli
