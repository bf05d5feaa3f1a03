// SPDX-License-Identifier: MIT
#include "solve/pair_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "solve/start.h"
#include "solve/trace.h"
#include "support/duration.h"
#include "support/phase_names.h"
#include "support/statistics.h"
#include "support/text_table.h"

namespace cairn::cli {

using problems::Problem;

PairRun::PairRun(const SolveOptions& options, const LcpSolverEntry& entry, SolverClock clock)
    : options_(options), entry_(entry), solver_(entry.make(options.solver)), clock_(clock) {
  result_.label = entry.name;
}

void PairRun::Watch(const Problem& problem, const ErrorMeter& meter,
                    const std::function<void(const lcp::Iterate&)>& show) {
  // The clock of a budget is kept here: the solver's own would run on while we look.
  LcpOptions unlimited = options_.solver;
  unlimited.budget.reset();
  const auto solver = entry_.make(unlimited);
  const Start start = FindStart(problem, options_.start, solver_.get(), clock_);
  Trace::Setup setup{problem.lcp, meter, clock_, {}, show};
  if (options_.solver.budget) setup.budget = start.time + Milliseconds(*options_.solver.budget);
  Trace trace(std::move(setup), options_.errors);
  trace.Begin(start.x, start.time);
  const LcpOutcome outcome = solver->Solve(
      problem.lcp, start.x, [&trace](const lcp::Iterate& iterate) { return trace.Look(iterate); });
  trace.End(outcome);
  result_.levels = trace.TakeLevels();
  result_.history = trace.TakeHistory();
}

void PairRun::Solve(problems::Source* source, const std::function<void(int)>& show) {
  LcpSolverResult fresh;
  fresh.label = result_.label;
  fresh.times = std::move(result_.times);
  fresh.levels = std::move(result_.levels);
  if (source->steps() == 1) fresh.history = std::move(result_.history);
  result_ = std::move(fresh);
  double time = 0;
  for (int step = 0;; ++step) {
    show(step);
    const Problem& problem = source->current();
    time += SolveStep(problem, source->steps(), step);
    if (source->steps() > 1) AddMarchPoint(time);
    if (step + 1 == source->steps()) Answer(problem);
    if (!source->Advance(result_.x)) break;
  }
  result_.times.push_back(time);
}

LcpSolverResult PairRun::Finish(const BoxedLcp& lcp, const ErrorMeter& meter) {
  result_.time = Median(result_.times);
  result_.error = meter.Error(lcp, result_.x);
  result_.energy_error = meter.EnergyError(lcp, result_.x);
  return std::move(result_);
}

double PairRun::SolveStep(const Problem& problem, int steps, int step) {
  Start start = FindStart(problem, options_.start, solver_.get(), clock_);
  const double begin = Now(clock_);
  LcpOutcome outcome = solver_->Solve(problem.lcp, start.x, {});
  const double time = Now(clock_) - begin + start.time;

  const LcpResidual residual = Measure(problem.lcp, outcome.x);
  if (step == 0 || !(residual.relative <= result_.residual.relative)) result_.residual = residual;
  result_.nested_time += start.time;
  result_.nested = std::move(start.grids);
  Add(outcome);
  const std::string reason = WhyNotSolved(outcome, residual.relative);
  if (reason.empty()) ++result_.steps_solved;
  if (!result_.failure) result_.stop = outcome.stop;
  if (!reason.empty() && !result_.failure) {
    result_.failure =
        steps == 1 ? reason : fmt::format("problem {} of {}: {}", step + 1, steps, reason);
  }
  result_.w = problem.lcp.M * outcome.x + problem.lcp.q;
  result_.x = std::move(outcome.x);
  return time;
}

void PairRun::Add(const LcpOutcome& outcome) {
  result_.sweeps += outcome.sweeps;
  result_.factorisations += outcome.factorisations;
  result_.analyses += outcome.analyses;
  result_.steps_accepted += outcome.steps_accepted;
  result_.steps_restored += outcome.steps_restored;
  for (const auto& [name, phase] : kPhases) result_.phases.*phase += outcome.phases.*phase;
  result_.factor_nonzeros = std::max(result_.factor_nonzeros, outcome.factor_nonzeros);
}

std::string PairRun::WhyNotSolved(const LcpOutcome& outcome, double residual) const {
  if (!outcome.failure.empty()) return outcome.failure;
  if (residual <= options_.solver.tolerance) return "";
  // The solver's own running sums may be more hopeful than a fresh product with M.
  const bool disagrees = outcome.stop == "converged";
  return fmt::format("{} at residual {:.2e}", disagrees ? "not converged as it says" : outcome.stop,
                     residual);
}

void PairRun::AddMarchPoint(double time) {
  result_.history.push_back({.time = time,
                             .sweeps = static_cast<int>(result_.sweeps),
                             .factorisations = static_cast<int>(result_.factorisations),
                             .residual = result_.residual.relative});
}

void PairRun::Answer(const Problem& problem) {
  for (const problems::Answer& answer : problem.answers) {
    const AnswerResult& result =
        result_.answers.emplace_back(AnswerResult{.name = answer.name,
                                                  .source = answer.source,
                                                  .value = answer.measure(result_.x),
                                                  .expected = answer.expected,
                                                  .tolerance = answer.tolerance});
    if (!result.ok() && !result_.failure) {
      result_.failure = fmt::format("'{}' is {} off, {} allowed", answer.name,
                                    FormatNumber(std::abs(result.value - result.expected)),
                                    FormatNumber(result.tolerance));
    }
  }
}

}  // namespace cairn::cli
