// SPDX-License-Identifier: MIT
#include "lcp_solver.h"

#include <cmath>

#include "interior_point/barrier.h"
#include "lcp_state.h"
#include "pgs/matrix_pgs.h"
#include "subspace/paper.h"
#include "subspace/set_search.h"

namespace cairn {
namespace {

/// Measuring and writing the result costs about as much as this many sweeps.
constexpr double kFinishSweeps = 2;

Report Refuse(Status status, int row = -1) {
  Report report;
  report.status = status;
  report.bad_row = row;
  return report;
}

}  // namespace

Report LcpSolver::Solve(const BoxedLcp& problem, const Settings& settings, const Observer& observer,
                        Eigen::VectorXd* x) {
  BudgetMeter meter(settings.budget, kFinishSweeps * static_cast<double>(problem.size()), &prices_);
  Report report = Validate(problem);
  if (!report.ok()) return report;
  if (x->size() != problem.size()) return Refuse(Status::kWrongSize);
  for (int row = 0; row < static_cast<int>(x->size()); ++row) {
    if (!std::isfinite((*x)[row])) return Refuse(Status::kNotFinite, row);
  }
  if (!problem.M.isCompressed()) {
    BoxedLcp compressed = problem;
    compressed.M.makeCompressed();
    return Solve(compressed, settings, observer, x);
  }

  crew_.Follow(settings);
  LcpState state(problem, settings, &meter, &crew_, observer);
  state.Begin(*x);
  if (state.done()) return state.Finish(x);

  const auto attach = [&state, &problem](SparseCholesky* factor) {
    const PhaseClock clock = state.Time(&Phases::ordering);
    factor->Attach(problem.M);
  };
  const bool steps = settings.k_sm > 0;
  const Method method = settings.method;
  if (method == Method::kPgsSm && steps) {
    attach(&reduced_);
    whole_.AttachLike(reduced_);
    RunSetSearch(&state, &reduced_, &whole_);
  } else if (method == Method::kPgsSmLiteral && steps) {
    attach(&reduced_);
    RunPaper(&state, &reduced_);
  } else if (method == Method::kInteriorPoint) {
    attach(&whole_);
    RunInteriorPoint(&state, &whole_);
  } else {
    RunSweeps(&state);
  }
  report = state.Finish(x);
  report.analyses = reduced_.TakeAnalyses() + whole_.TakeAnalyses();
  return report;
}

}  // namespace cairn
