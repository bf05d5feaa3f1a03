// SPDX-License-Identifier: MIT
// Sweeps over the rows of a matrix against five lines of dense arithmetic.
#include "core/lcp/src/methods/matrix_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/core/support/lcp_problems.h"

namespace cairn::lcp {
namespace {

using Eigen::VectorXd;
using test::Planted;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// The specification.
void DenseSweep(const BoxedLcp& problem, double omega, Direction direction, VectorXd* x) {
  const Eigen::MatrixXd m(problem.M);
  for (int k = 0; k < x->size(); ++k) {
    const int i = direction == Direction::kForward ? k : static_cast<int>(x->size()) - 1 - k;
    const double w = m.row(i).dot(*x) + problem.q[i];
    (*x)[i] = std::clamp((*x)[i] - omega * w / m(i, i), problem.lo[i], problem.hi[i]);
  }
}

SweepRows Rows(const BoxedLcp& problem) { return LayOut(problem, {}); }

VectorXd AnyStart(int n, test::Random* random) {
  VectorXd x(n);
  for (double& entry : x) entry = random->Uniform(-1, 1);
  return x;
}

/// Whole entries and diagonals of 4: with n rows, x gets 3 n more binary digits in a sweep at most.
/// Up to n = 12 all sums are exact, in any order.
BoxedLcp ExactProblem(int n, std::uint64_t seed) {
  test::Random random(seed);
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(n, n);
  VectorXd q(n), lo(n), hi(n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < i; ++j) m(i, j) = m(j, i) = random.Index(3) - 1;
    m(i, i) = 4;
    q[i] = random.Index(9) - 4;
    lo[i] = -random.Index(4);
    hi[i] = random.Index(4);
  }
  return test::Boxed(m, q, lo, hi);
}

TEST(MatrixSweep, IsTheDenseSweepToTheBitWhereSumsAreExact) {
  for (int n = 1; n <= 12; ++n) {
    const BoxedLcp problem = ExactProblem(n, n);
    const SweepRows rows = Rows(problem);
    for (const double omega : {0.5, 1.0, 1.5}) {
      for (const Direction direction : {Direction::kForward, Direction::kReverse}) {
        VectorXd expected = VectorXd::Constant(n, 0.5), actual = expected;
        DenseSweep(problem, omega, direction, &expected);
        Sweep(rows, omega, direction, actual.data());
        EXPECT_EQ(actual, expected) << n << ' ' << omega;
      }
    }
  }
}

/// Most that a row can differ by from the dense sweep: sums of k terms in two orders are 2 k eps of
/// their absolute sum apart, and what rows before it differ by comes in through M. Clamping does
/// not magnify.
VectorXd MostDifferent(const BoxedLcp& problem, double omega, const VectorXd& before,
                       const VectorXd& after) {
  const Eigen::MatrixXd m = Eigen::MatrixXd(problem.M).cwiseAbs();
  const VectorXd size = before.cwiseAbs().cwiseMax(after.cwiseAbs());
  VectorXd most = VectorXd::Zero(before.size());
  for (int i = 0; i < most.size(); ++i) {
    const double sum = m.row(i).dot(size) + std::abs(problem.q[i]);
    const double terms = static_cast<double>((m.row(i).array() > 0).count()) + 6;
    most[i] = omega * (2 * terms * kEpsilon * sum + m.row(i).dot(most)) / m(i, i);
  }
  return most;
}

TEST(MatrixSweep, IsTheDenseSweepToRounding) {
  for (const int entries : {1, 4, 20, 100}) {
    test::Random random(entries);
    const Planted planted = test::Plant(test::DominantMatrix(120, entries, &random), {}, &random);
    const VectorXd start = AnyStart(120, &random);
    for (const double omega : {0.3, 1.0, 1.9}) {
      VectorXd expected = start, actual = start;
      DenseSweep(planted.problem, omega, Direction::kForward, &expected);
      Sweep(Rows(planted.problem), omega, Direction::kForward, actual.data());
      const VectorXd most = MostDifferent(planted.problem, omega, start, expected);
      EXPECT_LE(((actual - expected).cwiseAbs() - most).maxCoeff(), 0);
      EXPECT_GT((actual - start).norm(), 1);
    }
  }
}

// In the problem with its rows numbered backwards every sum has the same terms in the same order.
TEST(MatrixSweep, InReverseIsAForwardSweepOfTheReversedRowsToTheBit) {
  for (const int entries : {1, 6, 30}) {
    test::Random random(entries);
    const Planted planted = test::Plant(test::DominantMatrix(70, entries, &random), {}, &random);
    const BoxedLcp& problem = planted.problem;
    const Eigen::MatrixXd backwards = Eigen::MatrixXd(problem.M).reverse();
    const BoxedLcp reversed =
        test::Boxed(backwards, problem.q.reverse(), problem.lo.reverse(), problem.hi.reverse());
    VectorXd x = AnyStart(70, &random), y = x.reverse();
    for (int k = 0; k < 5; ++k) {
      const double moved = Sweep(Rows(problem), 1.2, Direction::kReverse, x.data());
      EXPECT_EQ(moved, Sweep(Rows(reversed), 1.2, Direction::kForward, y.data()));
      EXPECT_TRUE(test::SameBits(x, y.reverse()));
    }
  }
}

// Each relaxation with 0 < omega < 2 lowers the objective along its row, or leaves it.
TEST(MatrixSweep, NeverRaisesTheObjective) {
  for (const double omega : {0.05, 0.5, 1.0, 1.5, 1.95}) {
    test::Random random(11);
    const Planted planted = test::Plant(test::RedundantMatrix(60, 1e-4, &random), {}, &random);
    const SweepRows rows = Rows(planted.problem);
    VectorXd x = AnyStart(60, &random);
    x = x.cwiseMax(planted.problem.lo).cwiseMin(planted.problem.hi);
    const double first = Measure(planted.problem, x).objective;
    double last = first;
    for (int k = 0; k < 50; ++k) {
      Sweep(rows, omega, k % 2 == 0 ? Direction::kForward : Direction::kReverse, x.data());
      const double now = Measure(planted.problem, x).objective;
      EXPECT_LE(now, last + 1e-13 * std::abs(first)) << omega << ' ' << k;
      last = now;
    }
    EXPECT_LT(last, first);
  }
}

TEST(MatrixSweep, ReturnsHowFarTheRowsMoved) {
  test::Random random(12);
  const Planted planted = test::Plant(test::DominantMatrix(60, 6, &random), {}, &random);
  const VectorXd before = AnyStart(60, &random);
  VectorXd after = before;
  const double moved = Sweep(Rows(planted.problem), 1, Direction::kForward, after.data());
  const double expected = test::EnergyOfX(planted.problem, after - before);
  EXPECT_NEAR(std::sqrt(moved), expected, 1e-13 * expected);

  VectorXd solution = planted.x;
  const double left = Sweep(Rows(planted.problem), 1, Direction::kForward, solution.data());
  EXPECT_LT(std::sqrt(left), 1e-13 * test::EnergyOfX(planted.problem, planted.x));
}

/// Sweeps @p x once in each direction listed.
VectorXd Swept(const BoxedLcp& problem, VectorXd x, std::initializer_list<Direction> directions) {
  for (const Direction direction : directions) {
    Sweep(Rows(problem), 1, direction, x.data());
  }
  return x;
}

TEST(SweepOrder, IsTheOrderInWhichTheSolverSweeps) {
  constexpr Direction kForward = Direction::kForward, kReverse = Direction::kReverse;
  test::Random random(13);
  const Planted planted = test::Plant(test::RedundantMatrix(50, 1e-3, &random), {}, &random);
  const BoxedLcp& problem = planted.problem;
  const VectorXd zero = VectorXd::Zero(50);
  const VectorXd start = zero.cwiseMax(problem.lo).cwiseMin(problem.hi);
  const auto solved = [&](SweepOrder order) {
    return test::Solve(test::MatrixSweeps(3, order), problem, zero).x;
  };
  const VectorXd forward = Swept(problem, start, {kForward, kForward, kForward});
  const VectorXd reverse = Swept(problem, start, {kReverse, kReverse, kReverse});
  const VectorXd symmetric = Swept(problem, start, {kForward, kReverse, kForward});
  EXPECT_TRUE(test::SameBits(solved(SweepOrder::kForward), forward));
  EXPECT_TRUE(test::SameBits(solved(SweepOrder::kReverse), reverse));
  EXPECT_TRUE(test::SameBits(solved(SweepOrder::kSymmetric), symmetric));
  EXPECT_NE(forward, reverse);
  EXPECT_NE(forward, symmetric);
}

TEST(Psor, SweepsWithItsOmega) {
  test::Random random(14);
  const Planted planted = test::Plant(test::DominantMatrix(50, 6, &random), {}, &random);
  const VectorXd start = AnyStart(50, &random);
  VectorXd expected = start.cwiseMax(planted.problem.lo).cwiseMin(planted.problem.hi);
  Sweep(Rows(planted.problem), 1.3, Direction::kForward, expected.data());
  Settings settings = test::MatrixSweeps(1);
  settings.omega = 1.3;
  // plain Gauss-Seidel does not look at omega
  EXPECT_FALSE(test::SameBits(test::Solve(settings, planted.problem, start).x, expected));
  settings.method = Method::kPsor;
  EXPECT_TRUE(test::SameBits(test::Solve(settings, planted.problem, start).x, expected));
}

}  // namespace
}  // namespace cairn::lcp
