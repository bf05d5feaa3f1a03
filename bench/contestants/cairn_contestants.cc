// SPDX-License-Identifier: MIT
#include "contestants/cairn_contestants.h"

#include <fmt/format.h>

namespace cairn::cli {

void ObservedCairn::allSolved(const btContactSolverInfo& info, btIDebugDraw* debug_drawer) {
  ConstraintSolver::allSolved(info, debug_drawer);
  if (!observer_) return;
  const auto start = std::chrono::steady_clock::now();
  observer_(problem(), impulses());
  observing_ += std::chrono::steady_clock::now() - start;
}

void CairnContestant::Begin(const Effort& effort, btContactSolverInfo* info) {
  info->m_numIterations = effort.iterations;
  solver_.settings().budget = effort.units    ? Budget::Work(*effort.units)
                              : effort.budget ? Budget::Time(*effort.budget)
                                              : Budget::Unlimited();
}

Work CairnContestant::work() const {
  const Report& report = solver_.report();
  return {.iterations = report.sweeps,
          .steps_accepted = report.steps_accepted,
          .steps_restored = report.steps_restored,
          .factorisations = report.factorisations,
          .guarded = report.guarded};
}

std::string CairnContestant::refusal() const {
  const Report& report = solver_.report();
  // A world without dynamic bodies has nothing to solve.
  if (report.ok() || report.status == Status::kEmptyProblem) return {};
  return fmt::format("refused: {}", Describe(report.status));
}

}  // namespace cairn::cli
