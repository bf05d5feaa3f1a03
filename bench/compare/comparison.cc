// SPDX-License-Identifier: MIT
#include "compare/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "support/failure.h"
#include "support/statistics.h"

namespace cairn::cli {
namespace {

/// A change is certain if its interval keeps so much of the threshold away from no change.
constexpr double kCertainShare = 0.25;

/// "'old.json' has 300, 'new.json' has 60"
std::string Differ(const RunFile& before, const std::string& old_value, const RunFile& after,
                   const std::string& new_value) {
  return fmt::format("'{}' has {}, '{}' has {}", before.path, old_value, after.path, new_value);
}

void CheckCircumstances(const RunFile& before, const RunFile& after, Comparison* result) {
  for (size_t i = 0; i < before.required.size(); ++i) {
    const Circumstance &old_one = before.required[i], &new_one = after.required[i];
    if (old_one.value == new_one.value) continue;
    throw Failure(kUsage,
                  fmt::format("a comparison would say nothing, for the {} differ: {}", old_one.name,
                              Differ(before, old_one.value, after, new_one.value)));
  }
  for (size_t i = 0; i < before.expected.size(); ++i) {
    const Circumstance &old_one = before.expected[i], &new_one = after.expected[i];
    if (old_one.value == new_one.value) continue;
    result->warnings.push_back(
        fmt::format("{}: {}", old_one.name, Differ(before, old_one.value, after, new_one.value)));
  }
}

void NoteFewRepetitions(const RunFile& before, const RunFile& after, Comparison* result) {
  for (const RunFile* file : {&before, &after}) {
    const size_t repetitions = file->scenes.front().arithmetic.size();
    if (repetitions >= kFewestRepetitions) continue;
    result->warnings.push_back(
        fmt::format("'{}' has {} repetition{}: 'cairn run --repeat 20' sees smaller changes",
                    file->path, repetitions, repetitions == 1 ? "" : "s"));
  }
}

const RecordedScene& FindScene(const RecordedScene& wanted, const RunFile& before,
                               const RunFile& after) {
  for (const RecordedScene& scene : after.scenes) {
    if (scene.name != wanted.name) continue;
    if (scene.world == wanted.world) return scene;
    throw Failure(kUsage, fmt::format("the scenes {} differ: {}", wanted.name,
                                      Differ(before, wanted.world, after, scene.world)));
  }
  throw Failure(kUsage, fmt::format("'{}' lacks the scene {}, which '{}' has: make both with the "
                                    "same command",
                                    after.path, wanted.name, before.path));
}

const RecordedSolver& FindSolver(const RecordedSolver& wanted, const RecordedScene& scene,
                                 const RunFile& before, const RunFile& after) {
  for (const RecordedSolver& solver : scene.solvers) {
    if (solver.name != wanted.name) continue;
    if (solver.effort == wanted.effort) return solver;
    throw Failure(kUsage, fmt::format("{} was told differently: {}", wanted.name,
                                      Differ(before, wanted.effort, after, solver.effort)));
  }
  throw Failure(kUsage, fmt::format("'{}' lacks {} on {}, which '{}' has: make both with the same "
                                    "command",
                                    after.path, wanted.name, scene.name, before.path));
}

/// Whether the same frames count in all repetitions of both.
bool HaveSameFrames(const Repetitions& before, const Repetitions& after) {
  if (before.empty() || after.empty()) return false;
  const auto counts = [](double value) { return std::isfinite(value); };
  const std::vector<double>& first = before.front();
  const auto fits = [&](const std::vector<double>& values) {
    return std::equal(first.begin(), first.end(), values.begin(), values.end(),
                      [&](double a, double b) { return counts(a) == counts(b); });
  };
  return std::any_of(first.begin(), first.end(), counts) &&
         std::all_of(before.begin(), before.end(), fits) &&
         std::all_of(after.begin(), after.end(), fits);
}

double Pooled(double (*statistic)(std::span<const double>), const Repetitions& series) {
  std::vector<double> all;
  for (const auto& values : series) all.insert(all.end(), values.begin(), values.end());
  return statistic(all);
}

Verdict Judge(const Ratio& ratio, double threshold) {
  const double certain = 1 + threshold * kCertainShare;
  if (ratio.value > 1 + threshold && ratio.low > certain) return Verdict::kRegression;
  if (ratio.value < 1 / (1 + threshold) && ratio.high < 1 / certain) return Verdict::kImproved;
  const bool could_be_twice = ratio.high > 1 + 2 * threshold;
  return ratio.value > 1 + threshold || could_be_twice ? Verdict::kUnknown : Verdict::kSame;
}

Change CompareSolverTimes(const RecordedSolver& before, const RecordedScene& scene_before,
                          const RecordedSolver& after, const RecordedScene& scene_after,
                          double threshold) {
  Change change{.before = Pooled(&Median, before.times),
                .after = Pooled(&Median, after.times),
                .ratio = {},
                .verdict = Verdict::kNotMeasured};
  if (!HaveSameFrames(before.times, after.times)) return change;
  change.ratio = CompareTimes({before.times, scene_before.arithmetic, scene_before.memory},
                              {after.times, scene_after.arithmetic, scene_after.memory});
  change.verdict = Judge(change.ratio, threshold);
  return change;
}

Change CompareSolverErrors(const RecordedSolver& before, const RecordedSolver& after,
                           double threshold) {
  Change change{.before = Pooled(&Mean, before.residuals),
                .after = Pooled(&Mean, after.residuals),
                .ratio = {},
                .verdict = Verdict::kNotMeasured};
  if (!HaveSameFrames(before.residuals, after.residuals)) return change;
  change.ratio = CompareResiduals(before.residuals, after.residuals);
  change.verdict = Judge(change.ratio, threshold);
  return change;
}

/// Of the medians of repetitions [%].
double Spread(const Repetitions& series) {
  std::vector<double> medians;
  for (const auto& values : series) medians.push_back(Median(values));
  return 100 * (Largest(medians) / Quantile(medians, 0) - 1);
}

std::string Describe(const SceneNoise& noise) {
  return fmt::format(
      "from repetition to repetition, the same work differed by {:.0f} % (arithmetic) and {:.0f} % "
      "(memory) in the old run, {:.0f} % and {:.0f} % in the new one",
      noise.arithmetic_before, noise.memory_before, noise.arithmetic_after, noise.memory_after);
}

double PercentAbove(double ratio) { return 100 * (ratio - 1); }

std::string Between(const Ratio& ratio) {
  return fmt::format("between {:+.1f} and {:+.1f} %", PercentAbove(ratio.low),
                     PercentAbove(ratio.high));
}

void Report(const SolverComparison& solver, const Change& change, const char* slower,
            const SceneNoise& noise, Comparison* result) {
  const std::string who = fmt::format("{}, {} ({})", solver.scene, solver.name, solver.effort);
  if (change.verdict == Verdict::kRegression) {
    result->regressions.push_back(fmt::format("{}: {:.1f} % {} ({}); {}.", who,
                                              PercentAbove(change.ratio.value), slower,
                                              Between(change.ratio), Describe(noise)));
  }
  if (change.verdict == Verdict::kUnknown) {
    result->unknown.push_back(fmt::format("{}: cannot tell whether it is {}: {}; {}.", who, slower,
                                          Between(change.ratio), Describe(noise)));
  }
}

void ReportFailures(const SolverComparison& solver, Comparison* result) {
  if (solver.failure_after.empty()) return;
  const std::string text = fmt::format("{}, {} ({}): failed {}", solver.scene, solver.name,
                                       solver.effort, solver.failure_after);
  if (solver.failure_before.empty()) {
    result->regressions.push_back(text + "; it did not fail before.");
  } else {
    result->warnings.push_back(text + ", and before " + solver.failure_before);
  }
}

/// Frames of such a solver do other work in each repetition.
bool GoesByTheClock(const RecordedSolver& solver) {
  return !solver.effort.ends_with("iterations") && !solver.effort.ends_with("units") &&
         solver.effort != "until done";
}

void CompareScene(const RecordedScene& before, const RecordedScene& after, const RunFile& old_file,
                  const RunFile& new_file, Comparison* result) {
  const SceneNoise& noise = result->noise.emplace_back(
      SceneNoise{before.name, Spread(before.arithmetic), Spread(before.memory),
                 Spread(after.arithmetic), Spread(after.memory)});
  for (const RecordedSolver& old_solver : before.solvers) {
    const RecordedSolver& new_solver = FindSolver(old_solver, after, old_file, new_file);
    SolverComparison& solver = result->solvers.emplace_back();
    solver.scene = before.name;
    solver.name = old_solver.name;
    solver.effort = old_solver.effort;
    solver.failure_before = old_solver.failure;
    solver.failure_after = new_solver.failure;
    ReportFailures(solver, result);
    if (!old_solver.failure.empty() || !new_solver.failure.empty()) continue;
    solver.time =
        CompareSolverTimes(old_solver, before, new_solver, after, result->thresholds.time);
    solver.error = CompareSolverErrors(old_solver, new_solver, result->thresholds.error);
    if (GoesByTheClock(old_solver)) {
      solver.time.verdict = solver.error.verdict = Verdict::kUnknown;
      result->unknown.push_back(fmt::format(
          "{}, {} ({}): goes by the clock, so that work and error follow the machine; not judged.",
          solver.scene, solver.name, solver.effort));
      continue;
    }
    Report(solver, solver.time, "slower", noise, result);
    Report(solver, solver.error, "less accurate", noise, result);
  }
  if (after.solvers.size() > before.solvers.size()) {
    result->warnings.push_back(fmt::format("{}: '{}' has solvers that '{}' lacks", before.name,
                                           new_file.path, old_file.path));
  }
}

}  // namespace

const char* Describe(Verdict verdict) {
  switch (verdict) {
    case Verdict::kSame:
      return "same";
    case Verdict::kRegression:
      return "REGRESSION";
    case Verdict::kImproved:
      return "improved";
    case Verdict::kUnknown:
      return "cannot tell";
    case Verdict::kNotMeasured:
      break;
  }
  return "-";
}

Comparison Compare(const RunFile& before, const RunFile& after, const Thresholds& thresholds) {
  Comparison result;
  result.thresholds = thresholds;
  CheckCircumstances(before, after, &result);
  NoteFewRepetitions(before, after, &result);
  for (const RecordedScene& scene : before.scenes) {
    CompareScene(scene, FindScene(scene, before, after), before, after, &result);
  }
  if (after.scenes.size() > before.scenes.size()) {
    result.warnings.push_back(
        fmt::format("'{}' has scenes that '{}' lacks", after.path, before.path));
  }
  return result;
}

}  // namespace cairn::cli
