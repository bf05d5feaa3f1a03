// SPDX-License-Identifier: MIT
#include "rows/cairn_row_solver.h"

#include <limits>

namespace cairn::cli {

namespace {

/// What the options of matrices mean to a frame; how long it takes is said later.
Settings SettingsOf(Method method, const LcpOptions& options) {
  Settings settings;
  settings.method = method;
  if (options.order != lcp::SweepOrder::kAutomatic) {
    const bool coloured = options.order == lcp::SweepOrder::kColoured;
    settings.path = coloured ? Path::kFast : Path::kReference;
  }
  settings.k_gs = options.k_gs;
  settings.k_sm = options.k_sm;
  settings.tolerance = options.tolerance;
  settings.threads = options.threads;
  settings.tuning.omega = options.omega;
  return settings;
}

/// Why a solve ended, fit for a narrow column.
std::string Name(StopReason reason) {
  switch (reason) {
    case StopReason::kNotStarted:
      return "refused";
    case StopReason::kTimeSpent:
    case StopReason::kWorkSpent:
      return "budget spent";
    default:
      return std::string(Describe(reason));
  }
}

}  // namespace

CairnRowSolver::CairnRowSolver(Method method, const LcpOptions& options)
    : solver_(SettingsOf(method, options)) {}

std::string CairnRowSolver::Prepare(const RowProblem& problem) {
  solver_.Reset();
  problem_ = &problem;
  row_impulses_ = problem.frame.row_impulses;
  point_impulses_ = problem.frame.point_impulses;
  twist_impulses_ = problem.frame.twist_impulses;
  joint_impulses_ = problem.frame.joint_impulses;
  velocities_.resize(problem.frame.bodies.size());
  return {};
}

void CairnRowSolver::IterateUntil(const RowLimit& limit) {
  solver_.settings().max_sweeps = limit.iterations.value_or(std::numeric_limits<int>::max());
  solver_.settings().budget = limit.time ? Budget::Time(*limit.time) : Budget::Unlimited();
  solver_.settings().tuning.clock = limit.clock;
  solver_.Solve(problem_->frame.problem(), impulses(), velocities_, &report_);
}

RowOutcome CairnRowSolver::Result() {
  RowOutcome outcome;
  outcome.impulses = AllImpulses(problem_->frame.problem(), impulses());
  outcome.velocities = velocities_;
  outcome.iterations = report_.sweeps;
  outcome.factorisations = report_.factorisations;
  outcome.steps_accepted = report_.steps_accepted;
  outcome.steps_restored = report_.steps_restored;
  outcome.ended = report_.stop == StopReason::kConverged || report_.stop == StopReason::kStationary;
  outcome.stop = Name(report_.stop);
  if (!report_.ok()) outcome.failure = Describe(report_.status);
  return outcome;
}

}  // namespace cairn::cli
