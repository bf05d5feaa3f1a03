// SPDX-License-Identifier: MIT
#pragma once

#include "compare/run_file.h"

namespace cairn::cli {

/// How many times as large something is in the later of two runs: 1.1 is 10 % more.
struct Ratio {
  double value = 1;
  double low = 1, high = 1;  ///< It lies between these, as value does.
};

/// A solver in one run and the machine beside it; all of the same frames.
struct MeasuredSolver {
  const Repetitions& times;                ///< Of the solver [ms].
  const Repetitions &arithmetic, &memory;  ///< Of the metronome [ms].
};

/// Fewer repetitions say little about how a machine varies.
inline constexpr int kFewestRepetitions = 3;

/// Compares what solvers took, on machines that were slower or faster at times.
///
/// Frames of the same number do the same work in every repetition of both runs. So (1) times of a
/// repetition are counted in arithmetic beats of the metronome in that repetition, which takes off
/// the clock of the core; (2) the quickest repetition of a frame is what it takes undisturbed; (3)
/// the ratio is the median over frames. The interval holds
///   - how ratios vary if other repetitions and frames are drawn (bootstrap, 98 %),
///   - twice what a difference of the memory beats explains, going by how times of repetitions
///     within a run rise with theirs,
///   - how much a program differs from itself the next time it is started: 1.5 % and 0.5 us,
///   - with fewer repetitions than kFewestRepetitions, 3 % more: what they leave in of
///   interruptions.
/// @pre the same frames are finite everywhere
Ratio CompareTimes(const MeasuredSolver& before, const MeasuredSolver& after);

/// The ratio of mean residuals, the mean over repetitions taken first; the interval is that of
/// other repetitions and frames. Exactly 1 where residuals are the same. Residuals below what
/// single precision can tell from zero, 1e-6 m/s, count as that.
Ratio CompareResiduals(const Repetitions& before, const Repetitions& after);

}  // namespace cairn::cli
