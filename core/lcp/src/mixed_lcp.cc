// SPDX-License-Identifier: MIT
#include "cairn/lcp/problem.h"

namespace cairn::lcp {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

}  // namespace

BoxedLcp ToBoxed(const MixedLcp& problem) {
  using Eigen::Index;
  const Index n_a = problem.a.size(), n_b = problem.b.size();
  const Matrix c_transposed = problem.C.transpose();

  // [A C; C' B] column by column, the upper block of a column first
  BoxedLcp boxed;
  boxed.M.resize(n_a + n_b, n_a + n_b);
  boxed.M.reserve(problem.A.nonZeros() + 2 * problem.C.nonZeros() + problem.B.nonZeros());
  const auto append = [&boxed](const Matrix& block, Index j, Index down, Index column) {
    for (Matrix::InnerIterator entry(block, j); entry; ++entry) {
      boxed.M.insertBack(entry.row() + down, column) = entry.value();
    }
  };
  for (Index j = 0; j < n_a + n_b; ++j) {
    boxed.M.startVec(j);
    append(j < n_a ? problem.A : problem.C, j < n_a ? j : j - n_a, 0, j);
    append(j < n_a ? c_transposed : problem.B, j < n_a ? j : j - n_a, n_a, j);
  }
  boxed.M.finalize();

  boxed.q.resize(n_a + n_b);
  boxed.q << problem.a, problem.b;
  boxed.lo.resize(n_a + n_b);
  boxed.lo << Eigen::VectorXd::Constant(n_a, -kInfinity), Eigen::VectorXd::Zero(n_b);
  boxed.hi = Eigen::VectorXd::Constant(n_a + n_b, kInfinity);
  return boxed;
}

}  // namespace cairn::lcp
