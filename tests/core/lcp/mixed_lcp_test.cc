// SPDX-License-Identifier: MIT
// The mixed problem in the letters of the paper against its boxed form.
#include "cairn/mixed_lcp.h"

#include <gtest/gtest.h>

#include "cairn/contact_problem.h"
#include "tests/core/support/lcp_problems.h"

namespace cairn::lcp {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Blocks of one definite matrix.
MixedLcp AnyMixed(int n_a, int n_b, std::uint64_t seed) {
  test::Random random(seed);
  const MatrixXd m(test::DominantMatrix(n_a + n_b, 5, &random));
  MixedLcp mixed;
  mixed.A = m.topLeftCorner(n_a, n_a).sparseView();
  mixed.C = m.topRightCorner(n_a, n_b).sparseView();
  mixed.B = m.bottomRightCorner(n_b, n_b).sparseView();
  mixed.a.resize(n_a);
  mixed.b.resize(n_b);
  for (double& entry : mixed.a) entry = random.Uniform(-1, 1);
  for (double& entry : mixed.b) entry = random.Uniform(-1, 1);
  return mixed;
}

const std::pair<int, int> kSizes[] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {12, 0}, {0, 12}, {25, 15}};

TEST(MixedLcp, InBoxedFormIsTheBlockMatrix) {
  for (const auto& [n_a, n_b] : kSizes) {
    const MixedLcp mixed = AnyMixed(n_a, n_b, 1 + n_a);
    const BoxedLcp boxed = ToBoxed(mixed);
    MatrixXd expected(n_a + n_b, n_a + n_b);
    expected << MatrixXd(mixed.A), MatrixXd(mixed.C), MatrixXd(mixed.C).transpose(),
        MatrixXd(mixed.B);
    EXPECT_EQ(MatrixXd(boxed.M), expected);
    EXPECT_TRUE(boxed.M.isCompressed());
    EXPECT_EQ(boxed.M.nonZeros(), mixed.A.nonZeros() + 2 * mixed.C.nonZeros() + mixed.B.nonZeros());
    EXPECT_EQ(boxed.q.head(n_a), mixed.a);
    EXPECT_EQ(boxed.q.tail(n_b), mixed.b);
    EXPECT_TRUE((boxed.lo.head(n_a).array() == -kInfinity).all());
    EXPECT_TRUE((boxed.lo.tail(n_b).array() == 0).all());
    EXPECT_TRUE((boxed.hi.array() == kInfinity).all());
    EXPECT_TRUE(Validate(mixed).ok());
    EXPECT_TRUE(Validate(boxed).ok());
  }
}

TEST(MixedLcp, IsSolvedAsItsBoxedFormToTheBit) {
  for (const auto& [n_a, n_b] : kSizes) {
    const MixedLcp mixed = AnyMixed(n_a, n_b, 2 + n_a);
    for (const Method method : {Method::kPgs, Method::kPsor, Method::kPgsSm, Method::kPgsSmLiteral,
                                Method::kInteriorPoint}) {
      SCOPED_TRACE(static_cast<int>(method));
      const Settings settings = test::Until(method, 1e-10);
      const VectorXd start = VectorXd::LinSpaced(n_a + n_b, -1, 1);
      VectorXd u = start.head(n_a), v = start.tail(n_b);
      const Report report = Solver(settings).Solve(mixed, &u, &v);
      const test::LcpSolution boxed = test::Solve(settings, ToBoxed(mixed), start);
      EXPECT_TRUE(report.ok());
      EXPECT_EQ(report.stop, StopReason::kConverged);
      EXPECT_TRUE(test::SameBits(u, boxed.x.head(n_a)));
      EXPECT_TRUE(test::SameBits(v, boxed.x.tail(n_b)));
      EXPECT_EQ(report.sweeps, boxed.report.sweeps);
      EXPECT_EQ(report.factorisations, boxed.report.factorisations);
      EXPECT_EQ(report.residual_relative, boxed.report.residual_relative);
    }
  }
}

// The law in its own letters, to a residual of 1e-12 of a problem of size 1.
TEST(MixedLcp, SolutionObeysTheLawOfThePaper) {
  const MixedLcp mixed = AnyMixed(25, 15, 3);
  VectorXd u = VectorXd::Zero(25), v = VectorXd::Zero(15);
  const Report report = Solver(test::Until(Method::kPgsSm, 1e-12)).Solve(mixed, &u, &v);
  EXPECT_EQ(report.stop, StopReason::kConverged);
  const VectorXd equations = mixed.A * u + mixed.C * v + mixed.a;
  const VectorXd w = mixed.C.transpose() * u + mixed.B * v + mixed.b;
  const double size = std::sqrt(ToBoxed(mixed).M.diagonal().maxCoeff()) *
                      test::EnergyOfW(ToBoxed(mixed), ToBoxed(mixed).q);
  EXPECT_LE(equations.cwiseAbs().maxCoeff(), 1e-12 * size);
  EXPECT_GE(v.minCoeff(), 0);
  EXPECT_GE(w.minCoeff(), -1e-12 * size);
  for (int i = 0; i < 15; ++i) {
    const double d = mixed.B.coeff(i, i);
    EXPECT_LE(std::min(d * v[i], std::abs(w[i])), 1e-12 * size);
  }
  EXPECT_GT(v.maxCoeff(), 0.01);
  EXPECT_GT(w.maxCoeff(), 0.01);
}

/// Refused as kWrongSize, u and v not touched.
void ExpectWrongSize(const MixedLcp& mixed, VectorXd u, VectorXd v) {
  const VectorXd u_before = u, v_before = v;
  const Report report = Solver().Solve(mixed, &u, &v);
  EXPECT_EQ(report.status, Status::kWrongSize);
  EXPECT_EQ(report.bad_row, -1);
  EXPECT_EQ(report.stop, StopReason::kNotStarted);
  EXPECT_TRUE(test::SameBits(u, u_before));
  EXPECT_TRUE(test::SameBits(v, v_before));
}

TEST(MixedLcp, RefusesSizesThatDoNotFit) {
  const VectorXd u = VectorXd::Ones(4), v = VectorXd::Ones(3);
  const auto spoilt = [](auto spoil) {
    MixedLcp mixed = AnyMixed(4, 3, 4);
    spoil(&mixed);
    return mixed;
  };
  for (const MixedLcp& mixed :
       {spoilt([](MixedLcp* p) { p->A.resize(3, 4); }),
        spoilt([](MixedLcp* p) { p->A.resize(4, 5); }),
        spoilt([](MixedLcp* p) { p->B.resize(4, 4); }),
        spoilt([](MixedLcp* p) { p->C.resize(3, 4); }),
        spoilt([](MixedLcp* p) { p->C.resize(0, 0); }), spoilt([](MixedLcp* p) { p->a.resize(5); }),
        spoilt([](MixedLcp* p) { p->b.resize(0); })}) {
    EXPECT_EQ(Validate(mixed).status, Status::kWrongSize);
    ExpectWrongSize(mixed, u, v);
  }
  const MixedLcp good = AnyMixed(4, 3, 4);
  ExpectWrongSize(good, VectorXd::Ones(3), v);
  ExpectWrongSize(good, u, VectorXd::Ones(4));
  // seven values, but not four and three
  ExpectWrongSize(good, VectorXd::Ones(3), VectorXd::Ones(4));
}

// Rows are counted u first, then v.
TEST(MixedLcp, NamesTheRowOfTheBoxedForm) {
  const auto refused = [](const MixedLcp& mixed) {
    VectorXd u = VectorXd::Constant(4, -2), v = VectorXd::Constant(3, -2);
    const Report report = Solver().Solve(mixed, &u, &v);
    EXPECT_TRUE(test::SameBits(u, VectorXd::Constant(4, -2)));
    EXPECT_TRUE(test::SameBits(v, VectorXd::Constant(3, -2)));
    return report;
  };
  MixedLcp mixed = AnyMixed(4, 3, 5);
  mixed.b[1] = kInfinity;
  EXPECT_EQ(refused(mixed).status, Status::kNotFinite);
  EXPECT_EQ(refused(mixed).bad_row, 5);

  mixed = AnyMixed(4, 3, 5);
  mixed.B.coeffRef(2, 2) = -1;
  EXPECT_EQ(refused(mixed).status, Status::kBadDiagonal);
  EXPECT_EQ(refused(mixed).bad_row, 6);

  mixed = AnyMixed(4, 3, 5);
  mixed.A.coeffRef(1, 3) += 1;
  EXPECT_EQ(refused(mixed).status, Status::kNotSymmetric);
  EXPECT_EQ(refused(mixed).bad_row, 1);
}

// What Eigen leaves in a matrix that is filled entry by entry.
TEST(MixedLcp, TakesMatricesThatAreNotCompressed) {
  const MixedLcp mixed = AnyMixed(6, 5, 6);
  MixedLcp gaps = mixed;
  for (test::Sparse* m : {&gaps.A, &gaps.B, &gaps.C}) {
    m->reserve(Eigen::VectorXi::Constant(m->cols(), 3));
    ASSERT_FALSE(m->isCompressed());
  }
  EXPECT_EQ(MatrixXd(ToBoxed(gaps).M), MatrixXd(ToBoxed(mixed).M));
}

}  // namespace
}  // namespace cairn::lcp
