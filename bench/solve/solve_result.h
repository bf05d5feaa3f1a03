// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cairn/mixed_lcp.h"
#include "solve/error_meter.h"
#include "solve/solve_options.h"
#include "support/machine/run_context.h"
#include "support/machine/stopwatch.h"
#include "support/statistics.h"

namespace cairn::cli {

/// Where a solver was: after so much time and work, with so much error.
struct HistoryPoint {
  double time = 0;  ///< Of the solver, coarser grids included [ms].
  int sweeps = 0, factorisations = 0;
  double error = kNotMeasured, energy_error = kNotMeasured;  ///< See ErrorMeter.
  double residual = kNotMeasured;                            ///< LcpResidual::relative
};

/// The first iterate with at most this error; none if there was none.
struct LevelReached {
  double level = 0;
  std::optional<HistoryPoint> first;
};

/// A coarser grid that was solved for the start.
struct NestedGrid {
  Eigen::Index size = 0;
  double time = 0;  ///< Solving and bringing the answer to the next grid [ms].
  int sweeps = 0, factorisations = 0;
};

struct AnswerResult {
  std::string name, source;
  double value = kNotMeasured, expected = 0, tolerance = 0;
  bool ok() const;
};

/// One solver on one problem or march.
struct LcpSolverResult {
  std::string label;
  /// Coarser grids included, and the sum over the problems of a march [ms]: of each repetition,
  /// with nobody looking on, and their median.
  std::vector<double> times;
  double time = kNotMeasured;
  double prepare_time = 0;         ///< Of a recorded frame: into the memory of the solver [ms].
  double nested_time = 0;          ///< Part of the time that was spent on coarser grids.
  std::vector<NestedGrid> nested;  ///< From the coarsest on; of the last problem of a march.
  int steps_solved = 0;            ///< Problems of the march that were solved.
  /// Of the finest grid, and summed over a march.
  std::int64_t sweeps = 0, factorisations = 0, analyses = 0, steps_accepted = 0, steps_restored = 0;
  std::int64_t factor_nonzeros = 0;  ///< Of the largest factor.
  lcp::Phases phases;                ///< Of the finest grid, summed over a march.
  /// Of that problem of the march where `relative` is largest. Of a recorded frame: `max` [m/s] and
  /// `energy` [sqrt(J)], the rest NaN or 0.
  LcpResidual residual;
  double error = kNotMeasured, energy_error = kNotMeasured;
  std::vector<LevelReached> levels;
  std::vector<LevelReached> residual_levels;  ///< Of recorded frames: the same of the residual.
  /// Of a run that was watched; a march has a point after each problem.
  std::vector<HistoryPoint> history;
  std::vector<AnswerResult> answers;
  std::string stop;                    ///< Why it ended; of a march, the problem that failed.
  std::optional<std::string> failure;  ///< Why it is not solved.
  Eigen::VectorXd x, w;                ///< The result, and w = M x + q.
};

/// What is known of a recorded frame. Errors on it are those of velocities [m/s]: of the centre of
/// mass that is furthest off, and instead of the energy norm that of all momenta.
struct RowFacts {
  std::int64_t frame = -1;
  int bodies = 0, joint_rows = 0, points = 0;
  int limited_sweeps = 0;        ///< See RowProblem.
  double spread = kNotMeasured;  ///< How far apart two references are [m/s], see bench::Converged.
};

struct ProblemResult {
  std::string name, source;
  int generator_size = 0;  ///< 0 for a folder.
  std::vector<std::pair<std::string, double>> parameters;
  Eigen::Index size = 0, nonzeros = 0, free_rows = 0;
  int steps = 1;                 ///< Problems of the march.
  std::optional<RowFacts> rows;  ///< Of a recorded frame; `size` counts its rows.
  ErrorMeter::Truth truth = ErrorMeter::Truth::kNone;
  std::string truth_name;
  double best_residual = kNotMeasured;  ///< Of the truth, if it was found here.
  std::vector<LcpSolverResult> solvers;
};

/// Everything `cairn solve` knows, for every form of output.
struct SolveResult : RunContext {
  LcpOptions options;
  StartRule start = StartRule::kWarm;
  int repeat = 1;
  SolverClock clock = SolverClock::kThreadCpu;
  LcpOptions row_options;      ///< For recorded frames.
  std::vector<double> errors;  ///< Asked for, falling.
  std::vector<std::string> solvers;
  std::vector<ProblemResult> problems;
  std::vector<SkippedFolder> skipped;
  std::vector<UnreadFile> unread;

  bool any_failed() const;
  bool any_march() const;
  bool any_frame() const;   ///< Some problem is a recorded frame.
  bool any_matrix() const;  ///< Some problem is none.
};

}  // namespace cairn::cli
