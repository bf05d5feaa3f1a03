// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "run/result.h"
#include "support/text_table.h"

namespace cairn::cli {

/// Whether the times of that frame count: it is no warm-up, and no state was sampled in it.
bool IsTimed(const SceneResult& scene, int frame);

/// The frames of a solver that count, of all repetitions, in a few numbers; NaN where nothing was
/// measured. What is counted and not averaged is of the first repetition, `overruns` excepted.
struct Summary {
  /// Time in the solver [ms] where IsTimed().
  double p50 = kNotMeasured, p99 = kNotMeasured, p999 = kNotMeasured, max = kNotMeasured;
  int timed_frames = 0;
  std::optional<int> overruns;       ///< Timed frames above the budget, if there is one.
  double iterations = kNotMeasured;  ///< Mean.
  double residual_mean = kNotMeasured, residual_max = kNotMeasured;  ///< [m/s]
  double error_median = kNotMeasured, error_max = kNotMeasured;      ///< [m/s]
  int steps_accepted = 0, steps_restored = 0, factorisations = 0, guarded = 0;
};

Summary Summarise(const SolverResult& solver, const SceneResult& scene,
                  std::optional<std::chrono::nanoseconds> budget);

/// What the reference itself left: median over the samples [m/s].
double ReferenceResidual(const SceneResult& scene);

/// "3 (1 %)", "-" without a budget.
std::string FormatOverruns(const Summary& summary);

/// The scene in a sentence or two: who was most accurate at what price, what fell, who failed.
std::string Verdict(const SceneResult& scene, const RunResult& run);

}  // namespace cairn::cli
