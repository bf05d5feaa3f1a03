// SPDX-License-Identifier: MIT
#include "solve/row_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "measure/row_velocities.h"
#include "support/duration.h"
#include "support/statistics.h"

namespace cairn::cli {
namespace {

/// From one effort to the next.
const double kFactor = std::sqrt(2.0);
constexpr double kLeastTime = 0.02;  // [ms]

/// w = J v + E x - target of every row.
Eigen::VectorXd Speeds(const ContactProblem& problem, const RowOutcome& outcome) {
  Eigen::VectorXd w(static_cast<Eigen::Index>(problem.rows.size()));
  for (Eigen::Index i = 0; i < w.size(); ++i) {
    const Row& row = problem.rows[i];
    w[i] = bench::RowSpeed(row, outcome.velocities) + row.compliance * outcome.impulses[i] -
           row.target;
  }
  return w;
}

/// The first point at which an error was small enough, for each of the levels.
std::vector<LevelReached> FindLevels(const std::vector<double>& levels,
                                     const std::vector<HistoryPoint>& history,
                                     double HistoryPoint::*error) {
  std::vector<LevelReached> reached;
  for (const double level : levels) {
    LevelReached& to = reached.emplace_back(LevelReached{.level = level, .first = {}});
    const auto first = std::find_if(history.begin(), history.end(), [&](const HistoryPoint& point) {
      return point.*error <= level;
    });
    if (first != history.end()) to.first = *first;
  }
  return reached;
}

}  // namespace

std::vector<RowLimit> Efforts(const SolveOptions& options) {
  const auto& [budget, most] = std::pair(options.row_solver.budget, options.row_solver.max_sweeps);
  std::vector<RowLimit> efforts;
  if (most) {
    int last = 0;
    for (double effort = 1; effort < *most; effort *= kFactor) {
      const int iterations = static_cast<int>(std::lround(effort));
      if (std::exchange(last, iterations) == iterations || iterations >= *most) continue;
      efforts.push_back({.iterations = iterations, .time = budget});
    }
    efforts.push_back({.iterations = *most, .time = budget});
    return efforts;
  }
  const double end = Milliseconds(*budget);
  for (double effort = kLeastTime; effort < end / std::sqrt(kFactor); effort *= kFactor) {
    efforts.push_back(
        {.iterations = {}, .time = std::chrono::nanoseconds(static_cast<long long>(1e6 * effort))});
  }
  efforts.push_back({.iterations = {}, .time = *budget});
  return efforts;
}

RowRun::RowRun(const SolveOptions& options, const RowSolverEntry& entry, SolverClock clock,
               std::function<void(const std::string&)> show)
    : options_(options),
      entry_(entry),
      solver_(entry.make(options.row_solver)),
      clock_(clock),
      show_(std::move(show)) {}

bool RowRun::Try(const RowProblem& problem, const RowLimit& limit, RowOutcome* outcome,
                 double* time) {
  std::vector<double> times, prepare_times;
  for (int i = 0; i < options_.repeat; ++i) {
    const double begin = Now(clock_);
    const std::string refusal = solver_->Prepare(problem);
    prepare_times.push_back(Now(clock_) - begin);
    if (!refusal.empty()) {
      result_.stop = "refused";
      result_.failure = fmt::format("refused: {}", refusal);
      return false;
    }
    const double start = Now(clock_);
    solver_->IterateUntil(limit);
    times.push_back(Now(clock_) - start);
  }
  *outcome = solver_->Result();
  *time = Median(times);
  result_.times = std::move(times);
  result_.prepare_time = Median(prepare_times);
  if (outcome->failure.empty()) return true;
  result_.stop = outcome->stop;
  result_.failure = outcome->failure;
  return false;
}

void RowRun::Keep(const RowOutcome& outcome, const RowError& error, double time) {
  result_.history.push_back({.time = time,
                             .sweeps = outcome.iterations,
                             .factorisations = outcome.factorisations,
                             .error = error.velocity,
                             .energy_error = error.velocity_rms,
                             .residual = error.residual});
}

LcpSolverResult RowRun::Solve(const RowProblem& problem, const RowErrorMeter& meter) {
  result_ = {};
  result_.label = entry_.name;
  result_.residual.relative = result_.residual.max = result_.residual.energy = kNotMeasured;
  const std::vector<RowLimit> all = Efforts(options_);
  const bool curve = !options_.errors.empty();
  const std::span<const RowLimit> efforts = curve ? std::span(all) : std::span(all).last(1);
  RowOutcome outcome;
  RowError error;
  // the first time, memory is cold
  if (!Try(problem, efforts.back(), &outcome, &result_.time)) return std::move(result_);
  if (curve) Keep({}, meter.MeasureStart(), 0);
  for (const RowLimit& effort : efforts) {
    show_(fmt::format("{}, effort {} of {}", entry_.name, &effort - efforts.data() + 1,
                      efforts.size()));
    if (!Try(problem, effort, &outcome, &result_.time)) return std::move(result_);
    error = meter.Measure(outcome);
    if (curve) Keep(outcome, error, result_.time);
    if (outcome.ended) break;
  }
  Finish(problem, outcome, error);
  return std::move(result_);
}

void RowRun::Finish(const RowProblem& problem, const RowOutcome& last, const RowError& error) {
  result_.steps_solved = 1;
  result_.sweeps = last.iterations;
  result_.factorisations = last.factorisations;
  result_.steps_accepted = last.steps_accepted;
  result_.steps_restored = last.steps_restored;
  result_.residual.max = error.residual;
  result_.residual.energy = error.residual_energy;
  result_.error = error.velocity;
  result_.energy_error = error.velocity_rms;
  result_.stop = last.stop;
  result_.x = Eigen::Map<const Eigen::VectorXd>(last.impulses.data(),
                                                static_cast<Eigen::Index>(last.impulses.size()));
  result_.w = Speeds(problem.rows.problem(), last);
  result_.levels = FindLevels(options_.errors, result_.history, &HistoryPoint::error);
  result_.residual_levels = FindLevels(options_.errors, result_.history, &HistoryPoint::residual);
  const double tolerance = options_.row_solver.tolerance;
  if (!std::isfinite(error.residual)) {
    result_.failure = "the result is not a number";
  } else if (tolerance > 0 && !(error.residual <= tolerance)) {
    result_.failure = fmt::format("{} at residual {:.2e}", last.stop, error.residual);
  }
}

ProblemResult DescribeFrame(const RowProblem& problem, const RowErrorMeter& meter) {
  ProblemResult result;
  result.name = problem.name;
  result.source = problem.source;
  const ContactProblem rows = problem.rows.problem();
  result.size = static_cast<Eigen::Index>(rows.rows.size());
  result.free_rows = std::count_if(rows.rows.begin(), rows.rows.end(), [](const Row& row) {
    return row.parent == kNoRow && row.lo == -kInfinity && row.hi == kInfinity;
  });
  result.truth_name = std::string(1, '-');  // GCC 12 warns of an assignment
  RowFacts& facts = result.rows.emplace();
  facts.frame = problem.frame.frame;
  facts.bodies = static_cast<int>(rows.bodies.size());
  facts.joint_rows = problem.first_contact;
  facts.points = static_cast<int>(problem.frame.points.size());
  facts.limited_sweeps = problem.limited_sweeps;
  if (!meter.reference()) return result;
  const bench::Converged& reference = *meter.reference();
  result.truth = reference.reached ? ErrorMeter::Truth::kConverged : ErrorMeter::Truth::kBestFound;
  result.truth_name = reference.reached ? "reference" : "best";
  result.best_residual = reference.residual_max;
  facts.spread = reference.spread.max;
  return result;
}

}  // namespace cairn::cli
