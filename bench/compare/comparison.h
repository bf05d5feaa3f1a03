// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compare/ratio.h"
#include "compare/run_file.h"

namespace cairn::cli {

/// Changes that count, as shares: 0.05 is 5 %.
struct Thresholds {
  double time = 0.05, error = 0.25;
};

enum class Verdict {
  kSame,        ///< No change as large as the threshold; twice the threshold is ruled out.
  kRegression,  ///< Above the threshold, and certainly above a quarter of it.
  kImproved,    ///< The same the other way round.
  kUnknown,     ///< Neither can be said: too much noise.
  kNotMeasured
};

/// "same", "REGRESSION", "improved", "cannot tell" or "-".
const char* Describe(Verdict verdict);

/// A quantity of a solver in both runs.
struct Change {
  double before = 0, after = 0;  ///< Medians of times [ms], means of residuals [m/s].
  Ratio ratio;
  Verdict verdict = Verdict::kNotMeasured;
};

struct SolverComparison {
  std::string scene, name, effort;
  Change time, error;
  std::string failure_before, failure_after;
};

/// How noisy the machine was beside a scene, spreads of repetitions in both runs [%].
struct SceneNoise {
  std::string scene;
  double arithmetic_before, memory_before, arithmetic_after, memory_after;
};

struct Comparison {
  Thresholds thresholds;
  std::vector<SolverComparison> solvers;
  std::vector<SceneNoise> noise;
  std::vector<std::string> warnings;     ///< What the user should know, a sentence each.
  std::vector<std::string> regressions;  ///< A sentence each.
  std::vector<std::string> unknown;      ///< What cannot be told, a sentence each.
};

/// @throws Failure (kUsage) if the files are of different machines, builds or experiments, or the
/// later one lacks what the earlier one has.
Comparison Compare(const RunFile& before, const RunFile& after, const Thresholds& thresholds);

/// A row for each solver, below them the sentences.
std::string ToText(const Comparison& comparison);

/// The same, "schema_version": 1. Ratios are of the later run and the earlier; what was not
/// measured is null.
std::string ToJson(const Comparison& comparison);

}  // namespace cairn::cli
