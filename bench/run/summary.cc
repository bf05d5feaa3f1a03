// SPDX-License-Identifier: MIT
#include "run/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "support/duration.h"
#include "support/statistics.h"

namespace cairn::cli {
namespace {

/// A frame that was sampled is not timed, in any world: the caches of the solver were used by
/// others just before.
bool IsSampled(const SceneResult& scene, int frame) {
  return std::any_of(scene.samples.begin(), scene.samples.end(), [frame](const Sample& sample) {
    return frame == sample.frame || frame == sample.frame - 1;
  });
}

/// The frames of a solver that count, of all repetitions.
struct Counted {
  std::vector<double> times, iterations, residuals;

  void Add(const std::vector<Frame>& frames, const SceneResult& scene) {
    for (size_t i = scene.warmup; i < frames.size(); ++i) {
      if (IsTimed(scene, static_cast<int>(i))) times.push_back(frames[i].time);
      iterations.push_back(frames[i].iterations);
      residuals.push_back(frames[i].residual);
    }
  }
};

/// Errors closer than this are not told apart: the samples are few.
constexpr double kLevel = 1.1;

struct Ranked {
  const SolverResult* solver;
  Summary summary;
};

/// Solvers that finished and whose error is known, best first.
std::vector<Ranked> RankByError(const SceneResult& scene, const RunResult& run) {
  std::vector<Ranked> ranked;
  for (const SolverResult& solver : scene.solvers) {
    const Summary summary = Summarise(solver, scene, run.budget);
    if (!solver.failure && std::isfinite(summary.error_median))
      ranked.push_back({&solver, summary});
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) {
    return a.summary.error_median < b.summary.error_median;
  });
  return ranked;
}

std::string Place(const Ranked& entry) {
  std::string text =
      fmt::format("{} {} m/s ({} ms", entry.solver->label, FormatNumber(entry.summary.error_median),
                  FormatTime(entry.summary.p50));
  if (entry.summary.overruns) {
    text += *entry.summary.overruns == 0
                ? ", always within budget"
                : fmt::format(", over budget in {} of {} frames", *entry.summary.overruns,
                              entry.summary.timed_frames);
  }
  return text + ")";
}

std::string Fallen(const SceneResult& scene) {
  std::string labels;
  for (const SolverResult& solver : scene.solvers) {
    if (solver.standing && !*solver.standing) labels += (labels.empty() ? "" : ", ") + solver.label;
  }
  return labels.empty() ? "" : fmt::format(" Fallen: {}.", labels);
}

std::string Failures(const SceneResult& scene) {
  std::string text;
  for (const SolverResult& solver : scene.solvers) {
    if (solver.failure) {
      text += fmt::format(" Failed: {} at frame {}.", solver.label, solver.failure->frame);
    }
  }
  return text;
}

}  // namespace

bool RunResult::check_failed() const {
  for (const SceneResult& scene : scenes) {
    for (const SolverResult& solver : scene.solvers) {
      if (solver.is_ours && solver.failure) return true;
    }
  }
  return false;
}

bool IsTimed(const SceneResult& scene, int frame) {
  return frame >= scene.warmup && !IsSampled(scene, frame);
}

Summary Summarise(const SolverResult& solver, const SceneResult& scene,
                  std::optional<std::chrono::nanoseconds> budget) {
  Counted counted;
  counted.Add(solver.frames, scene);
  for (const std::vector<Frame>& frames : solver.repeated) counted.Add(frames, scene);
  const auto& [times, iterations, residuals] = counted;
  Summary summary;
  for (size_t i = scene.warmup; i < solver.frames.size(); ++i) {
    const Frame& frame = solver.frames[i];
    summary.steps_accepted += frame.steps_accepted;
    summary.steps_restored += frame.steps_restored;
    summary.factorisations += frame.factorisations;
    summary.guarded += frame.guarded;
  }
  summary.timed_frames = static_cast<int>(times.size());
  summary.p50 = Median(times);
  summary.p99 = Quantile(times, 0.99);
  summary.p999 = Quantile(times, 0.999);
  summary.max = Largest(times);
  if (budget) {
    const double limit = Milliseconds(*budget);
    summary.overruns = static_cast<int>(
        std::count_if(times.begin(), times.end(), [limit](double time) { return time > limit; }));
  }
  if (solver.counts_iterations) summary.iterations = Mean(iterations);
  summary.residual_mean = Mean(residuals);
  summary.residual_max = Largest(residuals);
  summary.error_median = Median(solver.velocity_errors);
  summary.error_max = Largest(solver.velocity_errors);
  return summary;
}

double ReferenceResidual(const SceneResult& scene) {
  std::vector<double> residuals;
  for (const Sample& sample : scene.samples) residuals.push_back(sample.reference_residual);
  return Median(residuals);
}

std::string FormatOverruns(const Summary& summary) {
  if (!summary.overruns || summary.timed_frames == 0) return "-";
  return fmt::format("{} ({:.0f} %)", *summary.overruns,
                     100.0 * *summary.overruns / summary.timed_frames);
}

std::string Verdict(const SceneResult& scene, const RunResult& run) {
  const std::vector<Ranked> ranked = RankByError(scene, run);
  std::string text;
  for (size_t i = 0; i < ranked.size(); ++i) {
    const bool level =
        i > 0 && ranked[i].summary.error_median < kLevel * ranked[i - 1].summary.error_median;
    text += (i == 0  ? "Median velocity error, best first: "
             : level ? ", about the same "
                     : ", ") +
            Place(ranked[i]);
  }
  text += text.empty() ? "No velocity errors were measured." : ".";
  return text + Fallen(scene) + Failures(scene);
}

}  // namespace cairn::cli
