// SPDX-License-Identifier: MIT
#include "lcp_solver.h"

#include <cmath>
#include <vector>

#include "lcp_state.h"
#include "methods/barrier.h"
#include "methods/matrix_pgs.h"
#include "methods/paper.h"
#include "methods/set_search.h"

namespace cairn::lcp {
namespace {

/// Measuring and writing the result costs about as much as this many sweeps.
constexpr double kFinishSweeps = 2;

using Matrix = Eigen::SparseMatrix<double>;

/// For every entry there is one across the diagonal.
bool HasSymmetricPattern(const Matrix& m) {
  // columns ascend, so entries of a row are asked for in the order in which it has them
  std::vector<int> next(m.outerIndexPtr(), m.outerIndexPtr() + m.cols());
  for (int j = 0; j < m.cols(); ++j) {
    for (Matrix::InnerIterator entry(m, j); entry; ++entry) {
      const Eigen::Index i = entry.row();
      if (next[i] == m.outerIndexPtr()[i + 1] || m.innerIndexPtr()[next[i]++] != j) return false;
    }
  }
  return true;
}

/// Sweeps and factors take columns for rows: what is stored in one triangle alone, zero or close to
/// it, gets a zero across the diagonal.
void MakePatternSymmetric(Matrix* m) {
  const Matrix across = 0 * Matrix(m->transpose());
  *m += across;
}

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
  if (!problem.M.isCompressed() || !HasSymmetricPattern(problem.M)) {
    BoxedLcp tidy = problem;
    tidy.M.makeCompressed();
    if (!HasSymmetricPattern(tidy.M)) MakePatternSymmetric(&tidy.M);
    return Solve(tidy, settings, observer, x);
  }

  crew_.Follow(settings.threads, settings.executor);
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

}  // namespace cairn::lcp
