// SPDX-License-Identifier: MIT
// What is refused, which row is named, and that nothing is written then.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "cairn/contact_problem.h"
#include "tests/core/support/lcp_problems.h"

namespace cairn::lcp {
namespace {

using Eigen::VectorXd;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr int kRows = 20;

BoxedLcp Good() {
  test::Random random(1);
  return test::Plant(test::DominantMatrix(kRows, 6, &random), {}, &random).problem;
}

const Method kMethods[] = {Method::kPgs, Method::kPsor, Method::kPgsSm, Method::kPgsSmLiteral,
                           Method::kInteriorPoint};

/// Refused by Validate() and by every method, and x, with NaN and all, is not touched.
void ExpectRefused(const BoxedLcp& problem, Status status, int row) {
  const Report judged = Validate(problem);
  EXPECT_EQ(judged.status, status);
  EXPECT_EQ(judged.bad_row, row);
  EXPECT_EQ(judged.stop, StopReason::kNotStarted);
  VectorXd start = VectorXd::LinSpaced(problem.size(), -3, 3);
  for (const Method method : kMethods) {
    VectorXd x = start;
    const Report report = Solver({.method = method}).Solve(problem, &x);
    EXPECT_EQ(report.status, status);
    EXPECT_EQ(report.bad_row, row);
    EXPECT_EQ(report.stop, StopReason::kNotStarted);
    EXPECT_EQ(report.sweeps, 0);
    EXPECT_TRUE(test::SameBits(x, start));
  }
}

/// The good problem with one thing wrong.
void ExpectRefusedAfter(const std::function<void(BoxedLcp*)>& spoil, Status status, int row) {
  BoxedLcp problem = Good();
  spoil(&problem);
  problem.M.makeCompressed();
  ExpectRefused(problem, status, row);
}

TEST(ValidateLcp, AcceptsAGoodProblem) {
  EXPECT_TRUE(Validate(Good()).ok());
  EXPECT_EQ(Validate(Good()).bad_row, -1);
  EXPECT_TRUE(Validate(BoxedLcp{}).ok());
}

TEST(ValidateLcp, RefusesSizesThatDoNotFit) {
  const VectorXd longer = VectorXd::Zero(kRows + 1);
  ExpectRefusedAfter([&](BoxedLcp* p) { p->q = longer; }, Status::kWrongSize, -1);
  ExpectRefusedAfter([&](BoxedLcp* p) { p->lo = longer; }, Status::kWrongSize, -1);
  ExpectRefusedAfter([&](BoxedLcp* p) { p->hi = longer; }, Status::kWrongSize, -1);
  ExpectRefusedAfter([](BoxedLcp* p) { p->M.conservativeResize(kRows + 1, kRows); },
                     Status::kWrongSize, -1);
  ExpectRefusedAfter([](BoxedLcp* p) { p->M.conservativeResize(kRows, kRows - 1); },
                     Status::kWrongSize, -1);
}

TEST(ValidateLcp, RefusesWhatIsNotFinite) {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    ExpectRefusedAfter([=](BoxedLcp* p) { p->q[7] = bad; }, Status::kNotFinite, 7);
    ExpectRefusedAfter([=](BoxedLcp* p) { p->M.coeffRef(5, 5) = bad; }, Status::kNotFinite, 5);
    const auto both = [=](BoxedLcp* p) { p->M.coeffRef(3, 9) = p->M.coeffRef(9, 3) = bad; };
    ExpectRefusedAfter(both, Status::kNotFinite, 3);
  }
  ExpectRefusedAfter([](BoxedLcp* p) { p->lo[4] = kNan; }, Status::kNotFinite, 4);
  ExpectRefusedAfter([](BoxedLcp* p) { p->hi[4] = kNan; }, Status::kNotFinite, 4);
}

TEST(ValidateLcp, NamesTheFirstOfSeveralRows) {
  ExpectRefusedAfter([](BoxedLcp* p) { p->q[7] = p->q[11] = kNan; }, Status::kNotFinite, 7);
  const auto bounds = [](BoxedLcp* p) { p->lo[19] = p->lo[6] = kInfinity; };
  ExpectRefusedAfter(bounds, Status::kBadBounds, 6);
}

TEST(ValidateLcp, RefusesBoundsWithNothingBetween) {
  const auto crossed = [](BoxedLcp* p) {
    p->lo[2] = 1;
    p->hi[2] = std::nextafter(1, 0);
  };
  ExpectRefusedAfter(crossed, Status::kBadBounds, 2);
  const auto above = [](BoxedLcp* p) { p->lo[2] = p->hi[2] = kInfinity; };
  ExpectRefusedAfter(above, Status::kBadBounds, 2);
  const auto below = [](BoxedLcp* p) { p->lo[2] = p->hi[2] = -kInfinity; };
  ExpectRefusedAfter(below, Status::kBadBounds, 2);
}

TEST(ValidateLcp, RefusesADiagonalThatIsNotPositive) {
  ExpectRefusedAfter([](BoxedLcp* p) { p->M.coeffRef(8, 8) = 0; }, Status::kBadDiagonal, 8);
  ExpectRefusedAfter([](BoxedLcp* p) { p->M.coeffRef(8, 8) = -1; }, Status::kBadDiagonal, 8);
  const auto missing = [](BoxedLcp* p) {
    p->M.prune([](auto row, auto column, double) { return row != 8 || column != 8; });
  };
  ExpectRefusedAfter(missing, Status::kBadDiagonal, 8);
}

/// Adds @p share of sqrt(M_ii M_jj) to one of two mirrored entries.
void Skew(BoxedLcp* p, int i, int j, double share) {
  p->M.coeffRef(i, j) += share * std::sqrt(p->M.coeff(i, i) * p->M.coeff(j, j));
  p->M.makeCompressed();
}

// 1e-8 of the diagonal is the limit; either triangle, a stored mirror or none.
TEST(ValidateLcp, RefusesAnAsymmetryAboveRounding) {
  for (const auto& [i, j] : {std::pair(2, 15), {15, 2}, {4, 5}, {5, 4}}) {
    for (const double sign : {1, -1}) {
      // clang 14 does not capture structured bindings
      const auto skew = [sign, i = i, j = j](BoxedLcp* p) { Skew(p, i, j, sign * 1.01e-8); };
      ExpectRefusedAfter(skew, Status::kNotSymmetric, std::min(i, j));
      BoxedLcp nearly = Good();
      Skew(&nearly, i, j, sign * 0.99e-8);
      EXPECT_TRUE(Validate(nearly).ok());
      VectorXd x = VectorXd::Zero(kRows);
      EXPECT_TRUE(Solver().Solve(nearly, &x).ok());
    }
  }
}

TEST(ValidateLcp, RefusesAMatrixWithOneTriangleOnly) {
  BoxedLcp problem = Good();
  problem.M = test::Sparse(problem.M.triangularView<Eigen::Lower>());
  EXPECT_EQ(Validate(problem).status, Status::kNotSymmetric);
}

TEST(ValidateLcp, RefusesAStartOfAnotherSizeOrNotFinite) {
  const BoxedLcp problem = Good();
  for (const Method method : kMethods) {
    Solver solver({.method = method});
    for (const int size : {0, kRows - 1, kRows + 1}) {
      const VectorXd start = VectorXd::Constant(size, 5);
      VectorXd x = start;
      const Report report = solver.Solve(problem, &x);
      EXPECT_EQ(report.status, Status::kWrongSize);
      EXPECT_EQ(report.bad_row, -1);
      EXPECT_TRUE(test::SameBits(x, start));
    }
    for (const double bad : {kNan, kInfinity, -kInfinity}) {
      VectorXd start = VectorXd::LinSpaced(kRows, -3, 3);
      start[6] = bad;
      VectorXd x = start;
      const Report report = solver.Solve(problem, &x);
      EXPECT_EQ(report.status, Status::kNotFinite);
      EXPECT_EQ(report.bad_row, 6);
      EXPECT_TRUE(test::SameBits(x, start));
    }
  }
}

TEST(ValidateLcp, RefusesSettingsBeforeTheProblem) {
  VectorXd x = VectorXd::Constant(kRows, 5);
  for (const Settings& bad : {Settings{.k_gs = 0}, Settings{.k_sm = -1}, Settings{.omega = 2},
                              Settings{.active_tolerance = -1}, Settings{.tolerance = kNan}}) {
    const Report report = Solver(bad).Solve(Good(), &x);
    EXPECT_EQ(report.status, Status::kBadSettings);
    EXPECT_EQ(Describe(report), Describe(FindBadSetting(bad)));
    EXPECT_GT(report.elapsed.count(), 0);
    EXPECT_EQ(x, VectorXd::Constant(kRows, 5));
  }
}

TEST(ValidateLcp, NamesTheSetting) {
  const auto name = [](const Settings& settings) { return FindBadSetting(settings).name; };
  EXPECT_EQ(name(Settings{}), nullptr);
  EXPECT_STREQ(name({.method = static_cast<Method>(5)}), "method");
  EXPECT_STREQ(name({.order = static_cast<SweepOrder>(-1)}), "order");
  EXPECT_STREQ(name({.max_sweeps = -1}), "max_sweeps");
  EXPECT_STREQ(name({.min_progress = kNan}), "min_progress");
  EXPECT_STREQ(name({.budget = Budget::Work(-1)}), "budget");
  EXPECT_STREQ(name({.min_sweeps = -1}), "min_sweeps");
  EXPECT_EQ(Describe(FindBadSetting({.threads = 0})), "threads is 0, must be 1 to 1024");
  EXPECT_EQ(Describe(FindBadSetting({.omega = 0})), "omega is 0, must be above 0 and below 2");
}

// A solver that has refused something goes on as if it had not seen it.
TEST(ValidateLcp, LeavesTheSolverAsItWas) {
  Solver solver, fresh;
  BoxedLcp bad = Good();
  bad.q[3] = kNan;
  VectorXd x = VectorXd::Zero(kRows), expected = x;
  EXPECT_FALSE(solver.Solve(bad, &x).ok());
  EXPECT_TRUE(solver.Solve(Good(), &x).ok());
  EXPECT_TRUE(fresh.Solve(Good(), &expected).ok());
  EXPECT_TRUE(test::SameBits(x, expected));
}

// Eigen leaves gaps between the columns of a matrix that was filled by insert() or coeffRef().
TEST(ValidateLcp, AcceptsAMatrixThatIsNotCompressed) {
  const BoxedLcp problem = Good();
  BoxedLcp gaps = problem;
  gaps.M.uncompress();
  gaps.M.reserve(Eigen::VectorXi::Constant(kRows, 5));
  ASSERT_FALSE(gaps.M.isCompressed());
  EXPECT_TRUE(Validate(gaps).ok());
  for (const Method method : kMethods) {
    SCOPED_TRACE(static_cast<int>(method));
    Settings settings = test::Until(method, 1e-12);
    settings.k_gs = 1;
    const test::LcpSolution expected = test::Solve(settings, problem);
    const test::LcpSolution actual = test::Solve(settings, gaps);
    EXPECT_EQ(expected.report.stop, StopReason::kConverged);
    EXPECT_EQ(actual.report.factorisations, expected.report.factorisations);
    EXPECT_TRUE(test::SameBits(actual.x, expected.x));
  }
}

}  // namespace
}  // namespace cairn::lcp
