// SPDX-License-Identifier: MIT
#include "methods/sparse_cholesky.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

#include "cholesky/front_cholesky.h"
#include "cholesky/minimum_degree.h"
#include "simd/target.h"

namespace cairn::lcp {
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
  std::vector<int> kept;     ///< rows of the pattern, nodes of the factor
  bool analysed = false;
  std::vector<int> diagonal;      ///< of each of them, the entry of M
  std::vector<NodePair> pairs;    ///< of them
  std::vector<int> off_diagonal;  ///< of each pair, the entry of M
  // a solve needs room of the factor's
  mutable FrontCholesky<double> factor{simd::ChooseTarget().target};
  mutable Eigen::VectorXd gathered;
  int analyses = 0;

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

  const int size = static_cast<int>(kept.size());
  diagonal.resize(size);
  // room for one more: see below
  const size_t most = static_cast<size_t>(m->nonZeros() - m->cols()) / 2 + 1;
  pairs.resize(most);
  off_diagonal.resize(most);
  size_t count = 0;
  for (int node = 0; node < size; ++node) {
    for (int k = m->outerIndexPtr()[kept[node]]; k < m->outerIndexPtr()[kept[node] + 1]; ++k) {
      const int other = place[m->innerIndexPtr()[k]];
      if (other == node) diagonal[node] = k;
      // written in any case: which of the two comes first is hard to predict
      pairs[count] = {node, other};
      off_diagonal[count] = k;
      count += other > node;
    }
  }
  pairs.resize(count);
  off_diagonal.resize(count);
  std::iota(place.begin(), place.begin() + size, 0);
  using Factor = FrontCholesky<double>;
  factor.Analyse(size, 1, pairs, std::span(place).first(size), Factor::Workers::kOne);
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
  impl_->order.resize(m.outerSize());
  MinimumDegreeOrder(m, impl_->order);
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

double SparseCholesky::factor_flops() const { return impl_->factor.pattern().flops(); }
double SparseCholesky::factor_nonzeros() const { return impl_->factor.pattern().nonzeros(); }
int SparseCholesky::TakeAnalyses() { return std::exchange(impl_->analyses, 0); }

bool SparseCholesky::Factorise(const Eigen::VectorXd& shift) {
  // rows that the pattern has but the set has not become rows of the identity
  const double* const values = impl_->m->valuePtr();
  const auto in = [this](int node) { return impl_->chosen[impl_->kept[node]] != 0; };
  FrontCholesky<double>& factor = impl_->factor;
  for (int node = 0; node < static_cast<int>(impl_->kept.size()); ++node) {
    *factor.diagonal(node) =
        in(node) ? values[impl_->diagonal[node]] + shift[impl_->kept[node]] : 1;
  }
  for (int pair = 0; pair < static_cast<int>(impl_->pairs.size()); ++pair) {
    const auto [first, second] = impl_->pairs[pair];
    *factor.upper(pair) = in(first) && in(second) ? values[impl_->off_diagonal[pair]] : 0;
  }
  return factor.Factorise();
}

void SparseCholesky::Solve(Eigen::VectorXd* rhs) const {
  const Eigen::Index size = static_cast<Eigen::Index>(impl_->kept.size());
  Eigen::VectorXd& gathered = impl_->gathered;
  gathered.resize(size);
  for (Eigen::Index k = 0; k < size; ++k) {
    const int row = impl_->kept[k];
    gathered[k] = impl_->chosen[row] ? (*rhs)[row] : 0;
  }
  impl_->factor.Solve({gathered.data(), static_cast<std::size_t>(size)});
  for (Eigen::Index k = 0; k < size; ++k) {
    const int row = impl_->kept[k];
    if (impl_->chosen[row]) (*rhs)[row] = gathered[k];
  }
}

}  // namespace cairn::lcp
