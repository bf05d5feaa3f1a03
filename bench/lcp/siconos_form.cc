// SPDX-License-Identifier: MIT
#include "lcp/siconos_form.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace cairn::cli {
namespace {

/// Entries of S, relative to sqrt(S_ii S_jj), that get no place in the sparse matrix: half of what
/// rounding adds to an entry of that size.
constexpr double kRounding = 1e-16;

Eigen::VectorXd Pick(const Eigen::VectorXd& all, const std::vector<int>& rows) { return all(rows); }

}  // namespace

std::string SiconosForm::Choose(const BoxedLcp& problem) {
  free_.clear();
  bounded_.clear();
  place_.clear();
  part_.clear();
  for (Eigen::Index i = 0; i < problem.size(); ++i) {
    const bool is_free = problem.lo[i] == -INFINITY;
    if (problem.hi[i] != INFINITY) {
      return fmt::format("Siconos has no solver for upper bounds, as that of row {}", i);
    }
    std::vector<int>& rows = is_free ? free_ : bounded_;
    part_.push_back(is_free ? Part::kFree : Part::kBounded);
    place_.push_back(static_cast<int>(rows.size()));
    rows.push_back(static_cast<int>(i));
  }
  return "";
}

double SiconosForm::Memory() const {
  if (free_.empty()) return 0;
  const double n_a = static_cast<double>(free_.size()), n_b = static_cast<double>(bounded_.size());
  // Per entry of S: three dense copies, a triplet of 16 bytes and the sparse entry of 12.
  return n_b * n_b * (3 * 8 + 16 + 12) + 8 * n_a * (n_b + 1);
}

std::string SiconosForm::Build(const BoxedLcp& problem, const Eigen::VectorXd& start) {
  const Eigen::VectorXd diagonal = problem.M.diagonal();
  if (!(problem.size() == 0 || diagonal.minCoeff() > 0)) return "the diagonal is not positive";
  shift_ = problem.lo;
  shift_(free_).setZero();
  const Eigen::VectorXd q = problem.q + problem.M * shift_;
  lcp_.q = Pick(q, bounded_);
  lcp_.start = Pick(start - shift_, bounded_);
  lcp_.M = free_.empty() ? problem.M : Block(problem, Part::kBounded, Part::kBounded);
  C_ = Block(problem, Part::kFree, Part::kBounded);
  inverse_.resize(static_cast<Eigen::Index>(free_.size()), rows() + 1);
  inverse_.leftCols(rows()) = C_.toDense();
  inverse_.col(rows()) = Pick(q, free_);
  if (!Eliminate(problem)) return "Siconos cannot factorise the free rows";

  scale_ = Pick(diagonal, bounded_).cwiseSqrt();
  const Eigen::VectorXd inverse_scale = scale_.cwiseInverse();
  lcp_.M = inverse_scale.asDiagonal() * lcp_.M * inverse_scale.asDiagonal();
  lcp_.q = lcp_.q.cwiseProduct(inverse_scale);
  lcp_.start = lcp_.start.cwiseProduct(scale_);
  const double left = lcp_.q.norm();
  const double all = problem.q.cwiseQuotient(diagonal.cwiseSqrt()).norm();
  tolerance_ratio_ = left > 0 && all > 0 ? all / left : 1;
  return "";
}

Eigen::VectorXd SiconosForm::Restore(const Eigen::VectorXd& z) const {
  const Eigen::VectorXd v = z.cwiseQuotient(scale_);
  Eigen::VectorXd x = shift_;
  x(bounded_) += v;
  x(free_) = -(inverse_.leftCols(rows()) * v + inverse_.col(rows()));
  return x;
}

Eigen::SparseMatrix<double> SiconosForm::Block(const BoxedLcp& problem, Part rows,
                                               Part columns) const {
  const auto size = [this](Part part) {
    return static_cast<Eigen::Index>(part == Part::kFree ? free_.size() : bounded_.size());
  };
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index j = 0; j < problem.M.outerSize(); ++j) {
    if (part_[static_cast<size_t>(j)] != columns) continue;
    for (Eigen::SparseMatrix<double>::InnerIterator entry(problem.M, j); entry; ++entry) {
      const auto row = static_cast<size_t>(entry.row());
      if (part_[row] != rows) continue;
      entries.emplace_back(place_[row], place_[static_cast<size_t>(j)], entry.value());
    }
  }
  Eigen::SparseMatrix<double> block(size(rows), size(columns));
  block.setFromTriplets(entries.begin(), entries.end());
  return block;
}

bool SiconosForm::Eliminate(const BoxedLcp& problem) {
  if (free_.empty()) return true;
  if (!SolveWithSiconos(Block(problem, Part::kFree, Part::kFree), &inverse_)) return false;
  lcp_.q -= C_.transpose() * inverse_.col(rows());
  Eigen::MatrixXd S = lcp_.M.toDense() - C_.transpose() * inverse_.leftCols(rows());
  // Symmetric again, as rounding leaves it not quite.
  S = (0.5 * (S + S.transpose())).eval();
  const Eigen::VectorXd root = S.diagonal().cwiseAbs().cwiseSqrt();
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index j = 0; j < S.cols(); ++j) {
    for (Eigen::Index i = 0; i < S.rows(); ++i) {
      if (std::abs(S(i, j)) <= kRounding * root[i] * root[j]) continue;
      entries.emplace_back(static_cast<int>(i), static_cast<int>(j), S(i, j));
    }
  }
  lcp_.M.setFromTriplets(entries.begin(), entries.end());
  return true;
}

}  // namespace cairn::cli
