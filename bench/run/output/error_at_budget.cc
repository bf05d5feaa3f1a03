// SPDX-License-Identifier: MIT
#include "run/output/run_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "run/summary.h"
#include "support/duration.h"
#include "support/statistics.h"

namespace cairn::cli {
namespace {

/// Errors closer than this are not told apart: the samples are few.
constexpr double kLevel = 1.1;
/// Errors below this are game accurate [m/s]: a sixteenth of what gravity adds in a frame.
constexpr double kAccurate = 0.01;
/// A solver keeps to a budget if no more than this share of its frames are longer.
constexpr double kMayOverrun = 0.05;
/// Where a run has no budget: a frame at 60 Hz [ms].
constexpr double kFrame = 1000.0 / 60;

std::string FormatBudget(double milliseconds) { return fmt::format("{:.4g} ms", milliseconds); }

/// The name of a kind of solver: a label without the iterations of its own.
std::string KindOf(const SolverResult& solver) {
  return solver.label.substr(0, solver.label.find('@'));
}

/// One solver of each kind: solvers of a kind have the same curves.
std::vector<const SolverResult*> Kinds(const SceneResult& scene) {
  std::vector<const SolverResult*> kinds;
  for (const SolverResult& solver : scene.solvers) {
    const bool known = std::any_of(kinds.begin(), kinds.end(), [&](const SolverResult* other) {
      return KindOf(*other) == KindOf(solver);
    });
    if (!known && !solver.curves.empty()) kinds.push_back(&solver);
  }
  return kinds;
}

/// The error of a kind of solver at a budget.
struct Candidate {
  const SolverResult* solver = nullptr;
  double error = kNotMeasured;
};

/// Kinds of solvers that were measured at a budget, the best first.
std::vector<Candidate> Rank(const SceneResult& scene, double budget) {
  std::vector<Candidate> candidates;
  for (const SolverResult* solver : Kinds(scene)) {
    const double error = ErrorAtBudget(*solver, budget);
    if (std::isfinite(error)) candidates.push_back({solver, error});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.error < b.error; });
  return candidates;
}

/// What the run itself has against the solver.
std::string Reservations(const SolverResult& solver, const SceneResult& scene,
                         const RunResult& run) {
  const Summary summary = Summarise(solver, scene, run.budget);
  std::string text;
  if (summary.overruns && *summary.overruns > kMayOverrun * summary.timed_frames) {
    text += fmt::format(" In its run {:.0f} % of the frames were longer than that.",
                        100.0 * *summary.overruns / summary.timed_frames);
  }
  if (solver.standing && !*solver.standing) text += " In its run the scene fell.";
  if (solver.failure) text += " In its run it failed.";
  return text;
}

std::string Recommend(const SceneResult& scene, const RunResult& run) {
  const double budget = run.budget ? Milliseconds(*run.budget) : kFrame;
  std::vector<Candidate> candidates = Rank(scene, budget);
  if (candidates.empty()) {
    return fmt::format("No solver had its error measured within {}.", FormatBudget(budget));
  }
  // of those that are accurate, one whose run went well
  const auto rest =
      std::find_if(candidates.begin(), candidates.end(),
                   [](const Candidate& candidate) { return candidate.error > kAccurate; });
  std::stable_partition(candidates.begin(), rest, [&](const Candidate& candidate) {
    return Reservations(*candidate.solver, scene, run).empty();
  });
  const Candidate& best = candidates.front();
  std::string text =
      fmt::format("With {} a frame use {}: median velocity error {} m/s", FormatBudget(budget),
                  KindOf(*best.solver), FormatNumber(best.error));
  if (candidates.size() > 1) {
    const double ratio = candidates[1].error / best.error;
    const std::string next = KindOf(*candidates[1].solver);
    if (candidates[1].error <= kAccurate) {
      text += fmt::format("; {} is as good, both are below {} m/s", next, kAccurate);
    } else {
      text += ratio >= kLevel ? fmt::format(", {:.2g} times less than {}, the next", ratio, next)
                              : fmt::format(", about the same as {}", next);
    }
  }
  return text + "." + Reservations(*best.solver, scene, run);
}

/// Budgets at which a solver of others was as good as any of Cairn.
std::string WhereCairnDoesNotHelp(const SceneResult& scene, const RunResult& run) {
  std::vector<std::string> budgets;
  int compared = 0;
  for (const double budget : FixedBudgets(run)) {
    double ours = INFINITY, others = INFINITY;
    for (const SolverResult* solver : Kinds(scene)) {
      const double error = ErrorAtBudget(*solver, budget);
      double& least = solver->is_ours ? ours : others;
      if (error < least) least = error;
    }
    if (std::isinf(ours) && std::isinf(others)) continue;
    ++compared;
    if (others <= std::max(ours * kLevel, kAccurate)) budgets.push_back(FormatBudget(budget));
  }
  if (compared == 0) return "";
  if (budgets.empty()) return " At every budget in the table below Cairn had the least error.";
  return fmt::format(" Cairn does not help at {}: another solver is as good there.",
                     fmt::join(budgets, ", "));
}

}  // namespace

std::vector<double> FixedBudgets(const RunResult& run) {
  std::vector<double> budgets = {0.25, 0.5, 1, 2, 4, 8.333, 16.67, 33.33};
  if (run.budget) {
    const double own = Milliseconds(*run.budget);
    const auto is_own = [own](double budget) { return std::abs(budget / own - 1) < 0.05; };
    budgets.erase(std::remove_if(budgets.begin(), budgets.end(), is_own), budgets.end());
    budgets.push_back(own);
  }
  std::sort(budgets.begin(), budgets.end());
  return budgets;
}

double ErrorAtBudget(const SolverResult& solver, double budget) {
  std::vector<double> errors;
  for (const std::vector<CurvePoint>& curve : solver.curves) {
    // from the least effort on; a solver that is done takes no longer with more
    const CurvePoint* last = nullptr;
    for (const CurvePoint& point : curve) {
      if (point.time <= budget) last = &point;
    }
    if (last == nullptr) return kNotMeasured;
    errors.push_back(last->error);
  }
  return Median(errors);
}

TextTable BudgetTable(const SceneResult& scene, const RunResult& run) {
  TextTable table;
  table.columns = {{"solver time", ""}};
  const std::vector<const SolverResult*> kinds = Kinds(scene);
  for (const SolverResult* solver : kinds) table.columns.push_back({KindOf(*solver), "m/s"});
  if (kinds.empty()) return table;
  for (const double budget : FixedBudgets(run)) {
    std::vector<std::string> row = {FormatBudget(budget)};
    for (const SolverResult* solver : kinds) {
      row.push_back(FormatNumber(ErrorAtBudget(*solver, budget)));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string Advice(const SceneResult& scene, const RunResult& run) {
  return Recommend(scene, run) + WhereCairnDoesNotHelp(scene, run);
}

}  // namespace cairn::cli
