// SPDX-License-Identifier: MIT
#include "problems/options/option_oracles.h"

#include <algorithm>
#include <cmath>

namespace cairn::problems {
namespace {

/// A sweep; the largest change of an x.
double Relax(const BoxedLcp& step, double relaxation, Eigen::VectorXd* x) {
  const int* const starts = step.M.outerIndexPtr();
  const int* const rows = step.M.innerIndexPtr();
  const double* const values = step.M.valuePtr();
  double largest = 0;
  for (int i = 0; i < step.size(); ++i) {
    double w = step.q[i], diagonal = 1;
    for (int k = starts[i]; k < starts[i + 1]; ++k) {
      w += values[k] * (*x)[rows[k]];
      if (rows[k] == i) diagonal = values[k];
    }
    const double old = (*x)[i];
    (*x)[i] = std::clamp(old - relaxation * w / diagonal, step.lo[i], step.hi[i]);
    largest = std::max(largest, std::abs((*x)[i] - old));
  }
  return largest;
}

/// From a bound on the spectral radius of Jacobi's iteration: the largest share of a diagonal entry
/// that the rest of its row makes up.
double BestRelaxation(const Eigen::SparseMatrix<double>& M) {
  double radius = 0;
  for (Eigen::Index i = 0; i < M.outerSize(); ++i) {
    double diagonal = 0, rest = 0;
    for (Eigen::SparseMatrix<double>::InnerIterator entry(M, i); entry; ++entry) {
      (entry.row() == i ? diagonal : rest) += std::abs(entry.value());
    }
    radius = std::max(radius, rest / diagonal);
  }
  return 2 / (1 + std::sqrt(1 - radius * radius));
}

}  // namespace

Eigen::VectorXd BrennanSchwartz(const BoxedLcp& step) {
  const Eigen::Index n = step.size();
  Eigen::VectorXd lower = Eigen::VectorXd::Zero(n), diagonal(n), right = -step.q;
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(step.M, i); entry; ++entry) {
      // M is symmetric: column i is row i
      if (entry.row() == i - 1) lower[i] = entry.value();
      if (entry.row() == i) diagonal[i] = entry.value();
    }
  }
  for (Eigen::Index i = n - 1; i > 0; --i) {
    const double factor = lower[i] / diagonal[i];
    diagonal[i - 1] -= factor * lower[i];
    right[i - 1] -= factor * right[i];
  }
  Eigen::VectorXd x(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double before = i > 0 ? lower[i] * x[i - 1] : 0;
    x[i] = std::max(0.0, (right[i] - before) / diagonal[i]);
  }
  return x;
}

Eigen::VectorXd RelaxToRounding(const Problem& step) {
  const double relaxation = BestRelaxation(step.lcp.M);
  Eigen::VectorXd x = step.start;
  // More than any grid here needs: the last bits may dance for ever.
  constexpr int kMaxSweeps = 20000;
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    if (Relax(step.lcp, relaxation, &x) <= 1e-15 * x.lpNorm<Eigen::Infinity>()) break;
  }
  return x;
}

}  // namespace cairn::problems
