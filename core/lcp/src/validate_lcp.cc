// SPDX-License-Identifier: MIT
// Judges problems in matrix form, and their settings.
#include <cmath>

#include "cairn/lcp/solver.h"

namespace cairn::lcp {
namespace {

/// Largest |M_ij - M_ji| / sqrt(M_ii M_jj) that passes for rounding.
constexpr double kAsymmetry = 1e-8;

using Matrix = Eigen::SparseMatrix<double>;
using Index = Eigen::Index;

Report Refuse(Status status, Index row) {
  Report report;
  report.status = status;
  report.bad_row = static_cast<int>(row);
  return report;
}

bool SizesAgree(const BoxedLcp& problem) {
  const Index n = problem.size();
  return problem.M.rows() == n && problem.M.cols() == n && problem.lo.size() == n &&
         problem.hi.size() == n;
}

Report CheckVectors(const BoxedLcp& problem) {
  for (Index i = 0; i < problem.size(); ++i) {
    const double lo = problem.lo[i], hi = problem.hi[i];
    if (!std::isfinite(problem.q[i]) || std::isnan(lo) || std::isnan(hi)) {
      return Refuse(Status::kNotFinite, i);
    }
    if (lo > hi || lo == kInfinity || hi == -kInfinity) return Refuse(Status::kBadBounds, i);
  }
  return {};
}

/// Finite entries, from the first row down, and a positive diagonal.
Report CheckEntries(const Matrix& m) {
  for (Index j = 0; j < m.cols(); ++j) {
    double diagonal = 0;
    Index last = -1;
    for (Matrix::InnerIterator entry(m, j); entry; ++entry) {
      if (entry.row() <= last || entry.row() >= m.rows()) return Refuse(Status::kWrongSize, j);
      last = entry.row();
      if (!std::isfinite(entry.value())) return Refuse(Status::kNotFinite, j);
      if (entry.row() == j) diagonal += entry.value();
    }
    if (!(diagonal > 0)) return Refuse(Status::kBadDiagonal, j);
  }
  return {};
}

/// Each column of M beside the same column of its transpose: both ascend.
Report CheckSymmetry(const Matrix& m) {
  const Eigen::VectorXd diagonal = m.diagonal();
  const Matrix transposed = m.transpose();
  for (Index j = 0; j < m.cols(); ++j) {
    Matrix::InnerIterator here(m, j), there(transposed, j);
    while (here || there) {
      const bool left = here && (!there || here.row() <= there.row());
      const bool right = there && (!here || there.row() <= here.row());
      const Index i = left ? here.row() : there.row();
      const double difference = (left ? here.value() : 0) - (right ? there.value() : 0);
      if (std::abs(difference) > kAsymmetry * std::sqrt(diagonal[i] * diagonal[j])) {
        return Refuse(Status::kNotSymmetric, j);
      }
      if (left) ++here;
      if (right) ++there;
    }
  }
  return {};
}

}  // namespace

Report Validate(const BoxedLcp& problem) {
  if (!SizesAgree(problem)) return Refuse(Status::kWrongSize, -1);
  Report report = CheckVectors(problem);
  if (report.ok()) report = CheckEntries(problem.M);
  if (report.ok()) report = CheckSymmetry(problem.M);
  return report;
}

Report Validate(const MixedLcp& problem) {
  const Index n_a = problem.a.size(), n_b = problem.b.size();
  const auto sized = [](const Matrix& m, Index rows, Index cols) {
    return m.rows() == rows && m.cols() == cols;
  };
  const bool agree =
      sized(problem.A, n_a, n_a) && sized(problem.B, n_b, n_b) && sized(problem.C, n_a, n_b);
  return agree ? Report{} : Refuse(Status::kWrongSize, -1);
}

}  // namespace cairn::lcp
