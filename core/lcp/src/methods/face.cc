// SPDX-License-Identifier: MIT
#include "methods/face.h"

#include <cmath>

namespace cairn::lcp {
namespace {

/// Refinements of one solve at most: each wins more digits than the proximal term costs, unless
/// the matrix is singular.
constexpr int kMostCorrections = 6;
/// What a refinement has to leave of the error to be followed by another.
constexpr double kWorthwhile = 0.1;

std::vector<char> FreeRows(const RowSet& set) {
  std::vector<char> free(set.size());
  for (size_t i = 0; i < set.size(); ++i) free[i] = set[i] == Side::kFree;
  return free;
}

void MoveToBounds(const BoxedLcp& problem, const RowSet& set, Eigen::VectorXd* y) {
  for (Eigen::Index i = 0; i < y->size(); ++i) {
    if (set[i] == Side::kLower) (*y)[i] = problem.lo[i];
    if (set[i] == Side::kUpper) (*y)[i] = problem.hi[i];
  }
}

}  // namespace

void FaceSolver::Choose(const RowSet& set) {
  const PhaseClock clock = state_->Time(&Phases::analysis);
  factor_->Choose(FreeRows(set));
}

bool FaceSolver::Fits(const RowSet& set) {
  Choose(set);
  return state_->Fits(factor_->factor_flops());
}

double FaceSolver::CostInSweeps(const RowSet& set) {
  Choose(set);
  return state_->SweepsFor(factor_->factor_flops());
}

bool FaceSolver::Factorise(const RowSet& set, double shift) {
  Choose(set);
  return state_->Factorise(factor_, shift * state_->diagonal());
}

double FaceSolver::Correct(const RowSet& set, Eigen::VectorXd* y) {
  Eigen::VectorXd step = state_->Slack(*y);
  double size = 0;
  for (Eigen::Index i = 0; i < step.size(); ++i) {
    if (set[i] == Side::kFree) size += step[i] * step[i] / state_->diagonal()[i];
  }
  state_->Solve(*factor_, &step);
  for (Eigen::Index i = 0; i < step.size(); ++i) {
    if (set[i] == Side::kFree) (*y)[i] -= step[i];
  }
  return std::sqrt(size);
}

bool FaceSolver::SolveExactly(const RowSet& set, Eigen::VectorXd* y) {
  MoveToBounds(state_->problem(), set, y);
  if (!Factorise(set, 0)) return false;
  Correct(set, y);
  return y->allFinite();
}

bool FaceSolver::Solve(const RowSet& set, Eigen::VectorXd* y) {
  MoveToBounds(state_->problem(), set, y);
  while (!Factorise(set, shift_)) {
    if (shift_ >= kMostShift || state_->done()) return false;
    shift_ *= 100;
  }
  double last = Correct(set, y);
  for (int k = 0; k < kMostCorrections; ++k) {
    const double error = Correct(set, y);
    if (!(error > 0 && error <= kWorthwhile * last)) break;
    last = error;
  }
  return true;
}

}  // namespace cairn::lcp
