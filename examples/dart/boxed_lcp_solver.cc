// SPDX-License-Identifier: MIT
#include "boxed_lcp_solver.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace cairn::dart {
namespace {

/// Solves with bounds of friction from the last one, at most.
constexpr int kMostSolves = 30;

/// Bounds of a row, where x bounds friction.
struct Bounds {
  double lo, hi;
};
Bounds BoundsOf(int i, const double* x, const double* lo, const double* hi, const int* findex) {
  if (findex[i] < 0 || findex[i] == i) return {lo[i], hi[i]};
  const double most = std::abs(hi[i] * std::max(0.0, x[findex[i]]));
  return {-most, most};
}

}  // namespace

BoxedLcpSolver::BoxedLcpSolver(double tolerance)
    : tolerance_(tolerance), solver_({.tolerance = tolerance / 10}) {}

const std::string& BoxedLcpSolver::getStaticType() {
  static const std::string type = "cairn::dart::BoxedLcpSolver";
  return type;
}

bool BoxedLcpSolver::solve(int n, double* A, double* x, double* b, int /*nub*/, double* lo,
                           double* hi, int* findex, bool earlyTermination) {
  // w = A x - b, with the zeros between bodies that do not touch left out
  problem_.M.resize(n, n);
  problem_.M.reserve(static_cast<Eigen::Index>(n) * n);
  const auto entry_of = [A, n](int i, int j) {
    return A[static_cast<std::ptrdiff_t>(i) * RowLength(n) + j];
  };
  for (int j = 0; j < n; ++j) {
    problem_.M.startVec(j);
    for (int i = 0; i < n; ++i) {
      const double entry = (entry_of(i, j) + entry_of(j, i)) / 2;
      if (entry != 0) problem_.M.insertBack(i, j) = entry;
    }
  }
  problem_.M.finalize();
  problem_.q = -Eigen::Map<const Eigen::VectorXd>(b, n);
  problem_.lo.resize(n);
  problem_.hi.resize(n);
  const double scale = std::max(problem_.q.cwiseAbs().maxCoeff(), 1e-12);

  Eigen::VectorXd result = Eigen::Map<const Eigen::VectorXd>(x, n);
  if (!(0 * result).isZero(0)) result.setZero();
  double residual = std::numeric_limits<double>::infinity();
  for (int solve = 0; solve < kMostSolves && residual > tolerance_ * scale; ++solve) {
    for (int i = 0; i < n; ++i) {
      const Bounds bounds = BoundsOf(i, result.data(), lo, hi, findex);
      problem_.lo[i] = bounds.lo;
      problem_.hi[i] = bounds.hi;
    }
    if (!solver_.Solve(problem_, &result).ok()) break;
    residual = LargestResidual(n, A, result.data(), b, lo, hi, findex);
  }
  const bool finite = residual < std::numeric_limits<double>::infinity();
  if (!finite || (earlyTermination && residual > tolerance_ * scale)) return false;
  std::copy_n(result.data(), n, x);
  return true;
}

double LargestResidual(int n, const double* A, const double* x, const double* b, const double* lo,
                       const double* hi, const int* findex) {
  double largest = 0;
  for (int i = 0; i < n; ++i) {
    const double* const row = A + static_cast<std::ptrdiff_t>(i) * RowLength(n);
    double w = -b[i];
    for (int j = 0; j < n; ++j) w += row[j] * x[j];
    const Bounds bounds = BoundsOf(i, x, lo, hi, findex);
    const double clamped = std::clamp(x[i] - w / row[i], bounds.lo, bounds.hi);
    const double error = row[i] * std::abs(x[i] - clamped);
    if (!(error <= std::numeric_limits<double>::max())) {
      return std::numeric_limits<double>::infinity();
    }
    largest = std::max(largest, error);
  }
  return largest;
}

}  // namespace cairn::dart
