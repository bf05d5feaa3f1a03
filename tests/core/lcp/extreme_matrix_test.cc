// SPDX-License-Identifier: MIT
// Problems in matrix form that pass Validate(), and were not meant to be.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "cairn/contact_problem.h"
#include "cairn/lcp/solver.h"

namespace cairn::lcp {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

/// 4 on the diagonal, -1 beside it, and @p more.
BoxedLcp Chain(int n, const Triplets& more) {
  Triplets entries = more;
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, 4.0);
  for (int i = 1; i < n; ++i) {
    entries.emplace_back(i, i - 1, -1.0);
    entries.emplace_back(i - 1, i, -1.0);
  }
  BoxedLcp problem;
  problem.M.resize(n, n);
  problem.M.setFromTriplets(entries.begin(), entries.end());
  problem.q = Eigen::VectorXd::Constant(n, -1);
  problem.lo = Eigen::VectorXd::Zero(n);
  problem.hi = Eigen::VectorXd::Constant(n, kInfinity);
  return problem;
}

constexpr Method kMethods[] = {Method::kPgs, Method::kPsor, Method::kPgsSm, Method::kPgsSmLiteral,
                               Method::kInteriorPoint};

TEST(HalfStoredMatrix, IsSolvedAsTheWholeOne) {
  constexpr int kSize = 8;
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(kSize);
  for (bool lower : {true, false}) {
    for (double value : {0.0, 1e-9}) {
      Triplets more;
      for (int i = 0; i < kSize; ++i) {
        for (int j = 0; j + 1 < i; ++j) more.emplace_back(lower ? i : j, lower ? j : i, value);
      }
      for (Method method : kMethods) {
        for (SweepOrder order : {SweepOrder::kForward, SweepOrder::kColoured}) {
          Solver solver({.method = method, .order = order, .tolerance = 1e-9});
          Eigen::VectorXd x = zero, whole = zero;
          EXPECT_TRUE(solver.Solve(Chain(kSize, more), &x).ok());
          EXPECT_TRUE(solver.Solve(Chain(kSize, {}), &whole).ok());
          // the tolerance, and entries of 1e-9 that only one of them has
          EXPECT_LT((x - whole).norm(), 1e-7);
        }
      }
    }
  }
}

TEST(UnsortedMatrix, IsRefused) {
  BoxedLcp problem = Chain(3, {});
  std::swap(problem.M.innerIndexPtr()[0], problem.M.innerIndexPtr()[1]);
  std::swap(problem.M.valuePtr()[0], problem.M.valuePtr()[1]);
  EXPECT_EQ(Validate(problem).status, Status::kWrongSize);
  problem = Chain(3, {});
  problem.M.innerIndexPtr()[1] = 0;  // the same row twice
  EXPECT_EQ(Validate(problem).status, Status::kWrongSize);
}

TEST(HugeNumbers, AreAnsweredWithOverflowAndNothingIsWritten) {
  for (double size : {1e160, 1e300, std::numeric_limits<double>::max()}) {
    for (Method method : kMethods) {
      for (int which : {0, 1, 2}) {
        BoxedLcp problem = Chain(2, {});
        Eigen::VectorXd x = Eigen::VectorXd::Constant(2, 0.5);
        if (which == 0) problem.lo[1] = size;
        if (which == 1) x[1] = size;
        if (which == 2) problem.q[1] = -size;
        const Eigen::VectorXd before = x;
        Solver solver({.method = method});
        const Report report = solver.Solve(problem, &x);
        EXPECT_TRUE(x.allFinite());
        EXPECT_TRUE(std::isfinite(report.residual_relative));
        // where squares fit, or methods do not square, the solution is still found
        if (report.status == Status::kOverflow) {
          EXPECT_EQ(x, before);
        } else {
          EXPECT_TRUE((x.array() >= problem.lo.array()).all());
        }
      }
    }
  }
}

TEST(HugeNumbers, AreNotMeasuredAsSolved) {
  BoxedLcp problem = Chain(2, {});
  problem.q[0] = 1e170;  // its square is not finite
  EXPECT_EQ(Measure(problem, Eigen::VectorXd::Zero(2)).relative, kInfinity);
}

}  // namespace
}  // namespace cairn::lcp
