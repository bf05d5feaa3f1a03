// SPDX-License-Identifier: MIT
#include "lcp/cairn_lcp_solver.h"

#include <fmt/format.h>

#include <limits>

namespace cairn::cli {
namespace {

int DefaultSweeps(lcp::Method method) {
  const bool ends_by_itself =
      method == lcp::Method::kPgsSm || method == lcp::Method::kInteriorPoint;
  return ends_by_itself ? std::numeric_limits<int>::max() : kDefaultMaxSweeps;
}

/// The solver times its phases under a budget of time only: one that nothing exhausts, if need be.
Budget BudgetOf(const LcpOptions& options) {
  if (options.budget) return Budget::Time(*options.budget);
  return options.phases ? Budget::Time(std::chrono::hours(10000)) : Budget::Unlimited();
}

}  // namespace

std::string Name(lcp::StopReason reason) {
  switch (reason) {
    case lcp::StopReason::kNotStarted:
      return "refused";
    case lcp::StopReason::kConverged:
      return "converged";
    case lcp::StopReason::kStationary:
      return "stationary";
    case lcp::StopReason::kStalled:
      return "stalled";
    case lcp::StopReason::kBrokeDown:
      return "broke down";
    case lcp::StopReason::kCancelled:
      return "cancelled";
    case lcp::StopReason::kSweepLimit:
      return "sweep limit";
    case lcp::StopReason::kTimeSpent:
    case lcp::StopReason::kWorkSpent:
      return "budget spent";
  }
  return "unknown";
}

lcp::Settings SettingsOf(lcp::Method method, const LcpOptions& options) {
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

CairnLcpSolver::CairnLcpSolver(lcp::Method method, const LcpOptions& options)
    : settings_(SettingsOf(method, options)) {}

LcpOutcome CairnLcpSolver::Solve(const BoxedLcp& problem, const Eigen::VectorXd& start,
                                 const lcp::Observer& observer) {
  lcp::Solver solver(settings_);
  if (observer) solver.Observe(observer);
  LcpOutcome outcome;
  outcome.x = start;
  const lcp::Report report = solver.Solve(problem, &outcome.x);
  outcome.sweeps = report.sweeps;
  outcome.factorisations = report.factorisations;
  outcome.analyses = report.analyses;
  outcome.factor_nonzeros = report.factor_nonzeros;
  outcome.phases = report.phases;
  outcome.stop = Name(report.stop);
  if (!report.ok()) outcome.failure = Describe(report.status);
  return outcome;
}

}  // namespace cairn::cli
