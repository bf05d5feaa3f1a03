// SPDX-License-Identifier: MIT
#include "subspace/sparse_cholesky.h"

#include <algorithm>
#include <span>
#include <utility>

#include "subspace/eigen_cholesky.h"

namespace cairn {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// Rows of a kept pattern that may be unused, before the smaller pattern pays for its analysis.
constexpr double kMostUnused = 0.1;

}  // namespace

struct SparseCholesky::Impl {
  const SparseMatrix* m = nullptr;
  std::vector<int> begins, rows;  ///< pattern of the M that was ordered
  std::vector<int> order;         ///< rows of M in the order of elimination

  std::vector<char> chosen;  ///< rows of the factor, one flag per row of M
  std::vector<int> kept;     ///< rows of the pattern, in the order of elimination
  bool analysed = false;
  SparseMatrix matrix;      ///< upper triangle of the pattern's rows, eliminated in this order
  std::vector<int> source;  ///< for each of its entries, the entry of M
  EigenCholesky factor;
  int analyses = 0;
  mutable Eigen::VectorXd ordered;

  bool SamePattern(const SparseMatrix& other) const;
  bool Serves(const std::vector<char>& in_set) const;
  void Analyse(const std::vector<char>& in_set);
};

bool SparseCholesky::Impl::SamePattern(const SparseMatrix& other) const {
  return std::ranges::equal(begins, std::span(other.outerIndexPtr(), other.outerSize() + 1)) &&
         std::ranges::equal(rows, std::span(other.innerIndexPtr(), other.nonZeros()));
}

bool SparseCholesky::Impl::Serves(const std::vector<char>& in_set) const {
  if (!analysed) return false;
  size_t wanted = 0, covered = 0;
  for (char in : in_set) wanted += in;
  for (int row : kept) covered += in_set[row];
  return covered == wanted && kept.size() - covered <= kMostUnused * static_cast<double>(covered);
}

void SparseCholesky::Impl::Analyse(const std::vector<char>& in_set) {
  kept.clear();
  std::vector<int> place(order.size(), -1);
  for (int row : order) {
    if (!in_set[row]) continue;
    place[row] = static_cast<int>(kept.size());
    kept.push_back(row);
  }

  // upper triangle, columns in the order of elimination, rows ascending inside a column
  const int size = static_cast<int>(kept.size());
  std::vector<std::pair<int, int>> column;  // place and entry of M
  source.clear();
  std::vector<int> inner, outer = {0};
  for (int c = 0; c < size; ++c) {
    column.clear();
    for (int k = m->outerIndexPtr()[kept[c]]; k < m->outerIndexPtr()[kept[c] + 1]; ++k) {
      const int r = place[m->innerIndexPtr()[k]];
      if (r >= 0 && r <= c) column.emplace_back(r, k);
    }
    std::sort(column.begin(), column.end());
    for (const auto& [r, k] : column) {
      inner.push_back(r);
      source.push_back(k);
    }
    outer.push_back(static_cast<int>(inner.size()));
  }
  matrix.resize(size, size);
  matrix.resizeNonZeros(static_cast<Eigen::Index>(inner.size()));
  std::ranges::copy(outer, matrix.outerIndexPtr());
  std::ranges::copy(inner, matrix.innerIndexPtr());
  std::fill_n(matrix.valuePtr(), inner.size(), 1.0);

  factor.Analyse(matrix);
  analysed = true;
  ++analyses;
}

SparseCholesky::SparseCholesky() : impl_(std::make_unique<Impl>()) {}
SparseCholesky::~SparseCholesky() = default;
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;

void SparseCholesky::Attach(const SparseMatrix& m) {
  impl_->m = &m;
  if (impl_->SamePattern(m)) return;
  impl_->analysed = false;
  impl_->begins.assign(m.outerIndexPtr(), m.outerIndexPtr() + m.outerSize() + 1);
  impl_->rows.assign(m.innerIndexPtr(), m.innerIndexPtr() + m.nonZeros());
  impl_->order = MinimumDegreeOrder(m);
}

void SparseCholesky::AttachLike(const SparseCholesky& other) {
  impl_->m = other.impl_->m;
  if (impl_->SamePattern(*impl_->m)) return;
  impl_->analysed = false;
  impl_->begins = other.impl_->begins;
  impl_->rows = other.impl_->rows;
  impl_->order = other.impl_->order;
}

void SparseCholesky::Choose(const std::vector<char>& in_set) {
  if (!impl_->Serves(in_set)) impl_->Analyse(in_set);
  impl_->chosen = in_set;
}

double SparseCholesky::factor_flops() const { return impl_->factor.flops(); }
double SparseCholesky::factor_nonzeros() const { return impl_->factor.nonzeros(); }
int SparseCholesky::TakeAnalyses() { return std::exchange(impl_->analyses, 0); }

bool SparseCholesky::Factorise(const Eigen::VectorXd& shift) {
  // rows that the pattern has but the set has not become rows of the identity
  const double* const values = impl_->m->valuePtr();
  SparseMatrix& matrix = impl_->matrix;
  for (int c = 0; c < matrix.cols(); ++c) {
    const int begin = matrix.outerIndexPtr()[c], end = matrix.outerIndexPtr()[c + 1];
    const bool in = impl_->chosen[impl_->kept[c]];
    for (int k = begin; k < end; ++k) {
      const bool both = in && impl_->chosen[impl_->kept[matrix.innerIndexPtr()[k]]];
      matrix.valuePtr()[k] = both ? values[impl_->source[k]] : 0;
    }
    // the diagonal is last: rows ascend
    matrix.valuePtr()[end - 1] = in ? matrix.valuePtr()[end - 1] + shift[impl_->kept[c]] : 1;
  }
  return impl_->factor.Factorise(matrix);
}

void SparseCholesky::Solve(Eigen::VectorXd* rhs) const {
  const Eigen::Index size = static_cast<Eigen::Index>(impl_->kept.size());
  Eigen::VectorXd& ordered = impl_->ordered;
  ordered.resize(size);
  for (Eigen::Index k = 0; k < size; ++k) {
    const int row = impl_->kept[k];
    ordered[k] = impl_->chosen[row] ? (*rhs)[row] : 0;
  }
  impl_->factor.Solve(&ordered);
  for (Eigen::Index k = 0; k < size; ++k) {
    const int row = impl_->kept[k];
    if (impl_->chosen[row]) (*rhs)[row] = ordered[k];
  }
}

}  // namespace cairn
