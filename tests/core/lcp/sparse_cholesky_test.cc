// SPDX-License-Identifier: MIT
// The sparse factor of a set of rows against the dense one of Eigen.
#include "core/lcp/src/methods/sparse_cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <limits>
#include <numeric>
#include <vector>

#include "tests/core/support/lcp_problems.h"

namespace cairn::lcp {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Flags = std::vector<char>;
using test::Sparse;

Flags AnyFlags(int n, double share, test::Random* random) {
  Flags flags(n);
  for (char& flag : flags) flag = random->Uniform(0, 1) < share;
  return flags;
}

std::vector<int> RowsOf(const Flags& flags) {
  std::vector<int> rows;
  for (int i = 0; i < static_cast<int>(flags.size()); ++i) {
    if (flags[i]) rows.push_back(i);
  }
  return rows;
}

VectorXd AnyVector(int n, test::Random* random) {
  VectorXd v(n);
  for (double& entry : v) entry = random->Uniform(-1, 1);
  return v;
}

/// Factorises and solves, and compares with the dense factor. Higham (Accuracy and stability of
/// numerical algorithms, theorem 10.4) bounds the backward error of either by 4 n (3 n + 1) eps / 2
/// of |A|, so that they are twice that times the condition apart.
void ExpectDenseSolution(SparseCholesky* factor, const Sparse& m, const Flags& flags,
                         const VectorXd& shift, test::Random* random) {
  const std::vector<int> rows = RowsOf(flags);
  const int n = static_cast<int>(rows.size());
  const MatrixXd shifted = MatrixXd(m) + MatrixXd(shift.asDiagonal());
  const MatrixXd a = shifted(rows, rows);
  const VectorXd rhs = AnyVector(static_cast<int>(flags.size()), random);

  factor->Choose(flags);
  ASSERT_TRUE(factor->Factorise(shift));
  VectorXd solution = rhs;
  factor->Solve(&solution);

  if (n > 0) {
    const VectorXd truth = a.llt().solve(rhs(rows));
    const double eps = std::numeric_limits<double>::epsilon();
    const double condition = a.norm() * a.inverse().norm();
    const double most = 4 * n * (3 * n + 1) * eps * condition;
    ASSERT_LT(most, 1e-2);
    EXPECT_LE((solution(rows) - truth).norm(), most * truth.norm());
  }
  for (size_t i = 0; i < flags.size(); ++i) {
    if (flags[i]) continue;
    EXPECT_EQ(solution[i], rhs[i]) << "row " << i << " is not in the set";
  }
}

TEST(SparseCholesky, SolvesAnySetOfRowsWithAnyShift) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    test::Random random(seed);
    for (const Sparse& m : {test::DominantMatrix(50, 6, &random), test::StencilMatrix(7),
                            test::RedundantMatrix(50, 1e-3, &random)}) {
      const int n = static_cast<int>(m.rows());
      SparseCholesky factor;
      factor.Attach(m);
      for (const double share : {0.0, 0.1, 0.5, 0.95, 1.0}) {
        const Flags flags = AnyFlags(n, share, &random);
        const VectorXd shift = AnyVector(n, &random).cwiseAbs();
        ExpectDenseSolution(&factor, m, flags, VectorXd::Zero(n), &random);
        ExpectDenseSolution(&factor, m, flags, shift, &random);
      }
    }
  }
}

// A singular matrix has a factor as soon as its diagonal is raised.
TEST(SparseCholesky, FactorisesASingularMatrixWithAShift) {
  test::Random random(21);
  const Sparse m = test::RedundantMatrix(40, 0, &random);
  SparseCholesky factor;
  factor.Attach(m);
  ExpectDenseSolution(&factor, m, Flags(40, 1), 1e-6 * VectorXd(m.diagonal()), &random);
}

/// All rows but @p out.
Flags Without(int n, const std::vector<int>& out) {
  Flags flags(n, 1);
  for (const int row : out) flags[row] = 0;
  return flags;
}

// 2 of 49 rows unused: the pattern of all serves, and its unused rows change nothing.
TEST(SparseCholesky, KeepsThePatternForASetThatFillsMostOfIt) {
  test::Random random(22);
  const Sparse m = test::StencilMatrix(7);
  const VectorXd none = VectorXd::Zero(49);
  SparseCholesky factor;
  factor.Attach(m);
  ExpectDenseSolution(&factor, m, Without(49, {}), none, &random);
  EXPECT_EQ(factor.TakeAnalyses(), 1);
  const double nonzeros = factor.factor_nonzeros(), flops = factor.factor_flops();

  ExpectDenseSolution(&factor, m, Without(49, {3, 24}), none, &random);
  ExpectDenseSolution(&factor, m, Without(49, {0}), none, &random);
  ExpectDenseSolution(&factor, m, Without(49, {}), none, &random);
  EXPECT_EQ(factor.TakeAnalyses(), 0);
  EXPECT_EQ(factor.factor_nonzeros(), nonzeros);
  EXPECT_EQ(factor.factor_flops(), flops);

  // the values may change under the pattern
  Sparse twice = 2 * m;
  factor.Attach(twice);
  ExpectDenseSolution(&factor, twice, Without(49, {5}), none, &random);
  EXPECT_EQ(factor.TakeAnalyses(), 0);
}

TEST(SparseCholesky, AnalysesASetThatDoesNotFitOrLeavesMuchUnused) {
  test::Random random(23);
  const Sparse m = test::StencilMatrix(7);
  const VectorXd none = VectorXd::Zero(49);
  SparseCholesky factor;
  factor.Attach(m);
  ExpectDenseSolution(&factor, m, Without(49, {3, 24}), none, &random);
  ExpectDenseSolution(&factor, m, Without(49, {3, 25}), none, &random);
  EXPECT_EQ(factor.TakeAnalyses(), 2);
  const double before = factor.factor_nonzeros();
  Flags half(49);
  for (int i = 0; i < 49; i += 2) half[i] = 1;
  ExpectDenseSolution(&factor, m, half, none, &random);
  EXPECT_EQ(factor.TakeAnalyses(), 1);
  EXPECT_LT(factor.factor_nonzeros(), before);

  // a fifth of the rows unused is not most of them used
  ExpectDenseSolution(&factor, m, Without(49, {}), none, &random);
  EXPECT_EQ(factor.TakeAnalyses(), 1);
  ExpectDenseSolution(&factor, m, Without(49, {1, 6, 11, 16, 21, 26, 31, 36, 41, 46}), none,
                      &random);
  EXPECT_EQ(factor.TakeAnalyses(), 1);

  // another pattern, of the same size
  const Sparse other = test::DominantMatrix(49, 4, &random);
  factor.Attach(other);
  ExpectDenseSolution(&factor, other, half, none, &random);
  EXPECT_EQ(factor.TakeAnalyses(), 1);
}

TEST(SparseCholesky, AttachedLikeAnotherSolvesTheSame) {
  test::Random random(24);
  const Sparse m = test::StencilMatrix(7);
  SparseCholesky first, second;
  first.Attach(m);
  second.AttachLike(first);
  ExpectDenseSolution(&second, m, AnyFlags(49, 0.5, &random), VectorXd::Zero(49), &random);
  SparseCholesky moved = std::move(second);
  ExpectDenseSolution(&moved, m, AnyFlags(49, 0.5, &random), VectorXd::Zero(49), &random);
}

/// 1 on the diagonal, -0.4 beside it.
Sparse Chain(int n) {
  Sparse m(n, n);
  for (int i = 0; i < n; ++i) {
    m.insert(i, i) = 1;
    if (i > 0) m.insert(i, i - 1) = m.insert(i - 1, i) = -0.4;
  }
  m.makeCompressed();
  return m;
}

// A chain has no fill: n + (n - 1) entries; columns of 2 entries cost 4, the last one 1. A full
// matrix has n (n + 1) / 2, and sum k^2 = n (n + 1) (2 n + 1) / 6. The set without row 3 of 8 is
// two chains.
TEST(SparseCholesky, CountsEntriesAndWorkOfItsFactor) {
  SparseCholesky factor;
  const Sparse chain = Chain(8);
  factor.Attach(chain);
  factor.Choose(Without(8, {3}));
  EXPECT_EQ(factor.factor_nonzeros(), 7 + 5);
  EXPECT_EQ(factor.factor_flops(), 5 * 4 + 2 * 1);
  factor.Choose(Without(8, {}));
  EXPECT_EQ(factor.factor_nonzeros(), 8 + 7);
  EXPECT_EQ(factor.factor_flops(), 7 * 4 + 1);

  const Sparse full = MatrixXd(MatrixXd::Ones(9, 9) + 9 * MatrixXd::Identity(9, 9)).sparseView();
  factor.Attach(full);
  factor.Choose(Flags(9, 1));
  EXPECT_EQ(factor.factor_nonzeros(), 45);
  EXPECT_EQ(factor.factor_flops(), 9 * 10 * 19 / 6);
}

TEST(SparseCholesky, SaysThatAMatrixIsNotPositiveDefinite) {
  const Eigen::Matrix3d dense{{1, 2, 0}, {2, 1, 0}, {0, 0, 1}};
  Sparse m = dense.sparseView();
  SparseCholesky factor;
  factor.Attach(m);
  factor.Choose({1, 1, 1});
  EXPECT_FALSE(factor.Factorise(Eigen::Vector3d::Zero()));
  EXPECT_FALSE(factor.Factorise(Eigen::Vector3d::Constant(0.99)));
  // eigenvalues 3 and -1: a shift above 1 is enough, and so is one row less
  EXPECT_TRUE(factor.Factorise(Eigen::Vector3d::Constant(1.01)));
  factor.Choose({1, 0, 1});
  EXPECT_TRUE(factor.Factorise(Eigen::Vector3d::Zero()));

  const Eigen::Matrix2d singular{{1, 1}, {1, 1}};
  Sparse s = singular.sparseView();
  factor.Attach(s);
  factor.Choose({1, 1});
  EXPECT_FALSE(factor.Factorise(Eigen::Vector2d::Zero()));
}

TEST(SparseCholesky, OfNoRowsDoesNothing) {
  SparseCholesky factor;
  const Sparse empty(0, 0);
  factor.Attach(empty);
  factor.Choose({});
  EXPECT_TRUE(factor.Factorise(VectorXd()));
  VectorXd rhs;
  factor.Solve(&rhs);
  EXPECT_EQ(factor.factor_nonzeros(), 0);
}

}  // namespace
}  // namespace cairn::lcp
