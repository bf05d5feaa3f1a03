// SPDX-License-Identifier: MIT
#include "rigid/envelope_cholesky.h"

#include <algorithm>
#include <cmath>

namespace cairn::bench {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// Breadth-first walk from a row over rows that are not yet `seen`, neighbours with few neighbours
/// first. Marks them `seen`.
std::vector<int> Walk(const Matrix& matrix, int start, std::vector<bool>* seen) {
  const auto degree = [&](int i) {
    return matrix.outerIndexPtr()[i + 1] - matrix.outerIndexPtr()[i];
  };
  std::vector<int> walk = {start}, next;
  (*seen)[start] = true;
  for (size_t head = 0; head < walk.size(); ++head) {
    next.clear();
    for (Matrix::InnerIterator entry(matrix, walk[head]); entry; ++entry) {
      const int j = static_cast<int>(entry.row());
      if ((*seen)[j]) continue;
      (*seen)[j] = true;
      next.push_back(j);
    }
    std::stable_sort(next.begin(), next.end(), [&](int a, int b) { return degree(a) < degree(b); });
    walk.insert(walk.end(), next.begin(), next.end());
  }
  return walk;
}

}  // namespace

std::vector<int> ReverseCuthillMcKee(const Matrix& matrix) {
  std::vector<bool> seen(matrix.cols());
  std::vector<int> order;
  for (int i = 0; i < matrix.cols(); ++i) {
    if (seen[i]) continue;
    // The end of a walk from the end of a walk is far out; its levels are narrow
    int start = i;
    for (int k = 0; k < 2; ++k) {
      std::vector<bool> visited = seen;
      start = Walk(matrix, start, &visited).back();
    }
    const std::vector<int> part = Walk(matrix, start, &seen);
    order.insert(order.end(), part.begin(), part.end());
  }
  std::reverse(order.begin(), order.end());
  return order;
}

EnvelopeCholesky::EnvelopeCholesky(const Matrix& matrix) : order_(ReverseCuthillMcKee(matrix)) {
  place_.resize(order_.size());
  for (size_t i = 0; i < order_.size(); ++i) place_[order_[i]] = static_cast<int>(i);
  SetEnvelope(matrix);
  ok_ = Factorise();
}

void EnvelopeCholesky::SetEnvelope(const Matrix& matrix) {
  const Eigen::Index n = matrix.cols();
  first_.resize(n);
  begin_.resize(n);
  Eigen::Index size = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    first_[i] = i;
    for (Matrix::InnerIterator entry(matrix, order_[i]); entry; ++entry) {
      first_[i] = std::min<Eigen::Index>(first_[i], place_[entry.row()]);
    }
    begin_[i] = size;
    size += i - first_[i] + 1;
  }

  values_.assign(size, 0.0);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Matrix::InnerIterator entry(matrix, order_[i]); entry; ++entry) {
      const Eigen::Index j = place_[entry.row()];
      if (j <= i) values_[begin_[i] + (j - first_[i])] = entry.value();
    }
  }
}

bool EnvelopeCholesky::Factorise() {
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(order_.size()); ++i) {
    double* const row = values_.data() + begin_[i];
    for (Eigen::Index j = first_[i]; j < i; ++j) {
      // What both rows have left of column j
      const Eigen::Index from = std::max(first_[i], first_[j]);
      const Eigen::Map<const Eigen::VectorXd> left(row + (from - first_[i]), j - from);
      row[j - first_[i]] -= left.dot(Left(j).tail(j - from));
      row[j - first_[i]] /= Pivot(j);
    }
    const double pivot = row[i - first_[i]] - Left(i).squaredNorm();
    if (!(pivot > 0)) return false;
    row[i - first_[i]] = std::sqrt(pivot);
  }
  return true;
}

Eigen::VectorXd EnvelopeCholesky::Solve(const Eigen::VectorXd& b) const {
  const Eigen::Index n = b.size();
  Eigen::VectorXd y(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    y[i] = (b[order_[i]] - Left(i).dot(y.segment(first_[i], i - first_[i]))) / Pivot(i);
  }
  for (Eigen::Index i = n - 1; i >= 0; --i) {
    y[i] /= Pivot(i);
    y.segment(first_[i], i - first_[i]) -= y[i] * Left(i);
  }
  Eigen::VectorXd x(n);
  for (Eigen::Index i = 0; i < n; ++i) x[order_[i]] = y[i];
  return x;
}

}  // namespace cairn::bench
