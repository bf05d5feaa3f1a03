// SPDX-License-Identifier: MIT
#include "lcp/cairn_lcp_solver.h"

#include <fmt/format.h>

#include <limits>

namespace cairn::cli {
namespace {

int DefaultSweeps(Method method) {
  const bool ends_by_itself = method == Method::kPgsSm || method == Method::kInteriorPoint;
  return ends_by_itself ? std::numeric_limits<int>::max() : kDefaultMaxSweeps;
}

/// The solver times its phases under a budget of time only: one that nothing exhausts, if need be.
Budget BudgetOf(const LcpOptions& options) {
  if (options.budget) return Budget::Time(*options.budget);
  return options.phases ? Budget::Time(std::chrono::hours(10000)) : Budget::Unlimited();
}

}  // namespace

std::string Name(StopReason reason) {
  switch (reason) {
    case StopReason::kNotStarted:
      return "refused";
    case StopReason::kConverged:
      return "converged";
    case StopReason::kStationary:
      return "stationary";
    case StopReason::kStalled:
      return "stalled";
    case StopReason::kBrokeDown:
      return "broke down";
    case StopReason::kCancelled:
      return "cancelled";
    case StopReason::kSweepLimit:
      return "sweep limit";
    case StopReason::kTimeSpent:
    case StopReason::kWorkSpent:
      return "budget spent";
  }
  return "unknown";
}

Settings SettingsOf(Method method, const LcpOptions& options) {
  return {.method = method,
          .order = options.order,
          .k_gs = options.k_gs,
          .k_sm = options.k_sm,
          .max_sweeps = options.max_sweeps.value_or(DefaultSweeps(method)),
          .tolerance = options.tolerance,
          .budget = BudgetOf(options),
          .threads = options.threads,
          .omega = options.omega,
          .active_tolerance = options.active_tolerance};
}

CairnLcpSolver::CairnLcpSolver(Method method, const LcpOptions& options)
    : settings_(SettingsOf(method, options)) {}

LcpOutcome CairnLcpSolver::Solve(const BoxedLcp& problem, const Eigen::VectorXd& start,
                                 const Observer& observer) {
  Solver solver(settings_);
  if (observer) solver.Observe(observer);
  LcpOutcome outcome;
  outcome.x = start;
  const Report report = solver.Solve(problem, &outcome.x);
  outcome.sweeps = report.sweeps;
  outcome.factorisations = report.factorisations;
  outcome.analyses = report.analyses;
  outcome.factor_nonzeros = report.factor_nonzeros;
  outcome.steps_accepted = report.steps_accepted;
  outcome.steps_restored = report.steps_restored;
  outcome.phases = report.phases;
  outcome.stop = Name(report.stop);
  if (!report.ok()) outcome.failure = Describe(report.status);
  return outcome;
}

}  // namespace cairn::cli
