// SPDX-License-Identifier: MIT
// What holds for every problem in matrix form. RapidCheck chooses the problems, from a fixed seed
// unless RC_PARAMS says otherwise.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numeric>
#include <vector>

#include "tests/core/support/lcp_problems.h"

namespace cairn::lcp {
namespace {

using Eigen::VectorXd;
using test::LcpSolution;
using test::Planted;
using test::Sparse;

const bool kSeeded = setenv("RC_PARAMS", "seed=20240607", /*overwrite=*/0) == 0;

test::Random AnyRandom() { return test::Random(*rc::gen::inRange<std::uint64_t>(0, 1'000'000)); }

Sparse AnyMatrix(test::Random* random) {
  const int n = *rc::gen::inRange(1, 40);
  switch (*rc::gen::inRange(0, 3)) {
    case 0:
      return test::DominantMatrix(n, *rc::gen::inRange(0, 12), random);
    case 1:
      return test::StencilMatrix(1 + n % 6);
    default:
      return test::RedundantMatrix(n, *rc::gen::element(1e-4, 1e-1), random);
  }
}

Planted AnyPlanted() {
  test::Random random = AnyRandom();
  const Sparse m = AnyMatrix(&random);
  const test::PlantOptions options{.unbounded = *rc::gen::element(0.0, 0.3, 1.0),
                                   .two_sided = *rc::gen::element(0.0, 0.5, 1.0),
                                   .active = *rc::gen::element(0.0, 0.5, 1.0),
                                   .degenerate = *rc::gen::element(0.0, 0.1, 0.5)};
  return test::Plant(m, options, &random);
}

Settings AnySettings() {
  Settings settings;
  settings.method = *rc::gen::element(Method::kPgs, Method::kPsor, Method::kPgsSm,
                                      Method::kPgsSmLiteral, Method::kInteriorPoint);
  settings.order =
      *rc::gen::element(SweepOrder::kForward, SweepOrder::kReverse, SweepOrder::kSymmetric);
  settings.omega = *rc::gen::element(0.5, 1.0, 1.5);
  settings.k_gs = *rc::gen::inRange(1, 8);
  settings.k_sm = *rc::gen::inRange(0, 4);
  settings.max_sweeps = *rc::gen::inRange(0, 60);
  settings.tolerance = *rc::gen::element(0.0, 1e-9, 1e-3);
  settings.budget = *rc::gen::element(Budget::Unlimited(), Budget::Work(100), Budget::Work(3000));
  return settings;
}

VectorXd AnyStart(const BoxedLcp& problem) {
  test::Random random = AnyRandom();
  VectorXd start(problem.size());
  for (double& x : start) x = random.Uniform(-2, 2);
  return start;
}

RC_GTEST_PROP(EveryLcp, EndsInsideItsBox, ()) {
  const Planted planted = AnyPlanted();
  const LcpSolution s = test::Solve(AnySettings(), planted.problem, AnyStart(planted.problem));
  RC_ASSERT(s.report.ok());
  RC_ASSERT(s.report.stop != StopReason::kNotStarted);
  RC_ASSERT(bool(test::InsideBox(planted.problem, s.x)));
}

RC_GTEST_PROP(EveryLcp, IsReportedAsItIsMeasured, ()) {
  const Planted planted = AnyPlanted();
  const LcpSolution s = test::Solve(AnySettings(), planted.problem, AnyStart(planted.problem));
  const LcpResidual measured = Measure(planted.problem, s.x);
  RC_ASSERT(s.report.residual_max == measured.max);
  RC_ASSERT(s.report.residual_energy == measured.energy);
  RC_ASSERT(s.report.residual_relative == measured.relative);
}

RC_GTEST_PROP(EveryLcp, GivesItsBitsAgain, ()) {
  const Planted planted = AnyPlanted();
  const Settings settings = AnySettings();
  const VectorXd start = AnyStart(planted.problem);
  const LcpSolution first = test::Solve(settings, planted.problem, start);
  RC_ASSERT(bool(test::SameBits(first.x, test::Solve(settings, planted.problem, start).x)));

  // and from a solver that has seen it and another one
  Solver used(settings);
  (void)test::Solve(&used, planted.problem, start);
  (void)test::Solve(&used, AnyPlanted().problem);
  used.Reset();
  const LcpSolution again = test::Solve(&used, planted.problem, start);
  RC_ASSERT(bool(test::SameBits(first.x, again.x)));
  RC_ASSERT(first.report.work == again.report.work);
  RC_ASSERT(first.report.analyses == again.report.analyses);
}

RC_GTEST_PROP(EveryLcp, IsSolvedByTheRobustMethods, ()) {
  const Planted planted = AnyPlanted();
  Settings settings = test::Until(*rc::gen::element(Method::kPgsSm, Method::kInteriorPoint), 1e-9);
  settings.k_gs = *rc::gen::inRange(1, 8);
  settings.k_sm = *rc::gen::inRange(1, 4);
  const LcpSolution s = test::Solve(settings, planted.problem, AnyStart(planted.problem));
  RC_ASSERT(s.report.stop == StopReason::kConverged);
  const double residuals =
      test::MostResidual(planted.problem, s.x) + test::MostResidual(planted.problem, planted.x);
  const double apart = test::EnergyOfX(planted.problem, s.x - planted.x);
  RC_ASSERT(apart <= test::MostApart(test::ScaledSpectrum(planted.problem), residuals));
}

/// Row i and unknown i in other units: x_i becomes x_i / s_i.
BoxedLcp Scaled(const BoxedLcp& problem, const VectorXd& s) {
  BoxedLcp scaled;
  scaled.M = s.asDiagonal() * problem.M * s.asDiagonal();
  scaled.q = s.cwiseProduct(problem.q);
  scaled.lo = problem.lo.cwiseQuotient(s);
  scaled.hi = problem.hi.cwiseQuotient(s);
  return scaled;
}

// Powers of 2 are exact, and d_i gets their squares, whose roots are exact: not a bit changes,
// whatever is decided on the way.
RC_GTEST_PROP(EveryLcp, TakesTheSameWayInAnyUnitsOfItsRows, ()) {
  const Planted planted = AnyPlanted();
  const Settings settings = AnySettings();
  const VectorXd start = AnyStart(planted.problem);
  VectorXd s(start.size());
  for (double& entry : s) entry = std::ldexp(1, *rc::gen::inRange(-20, 20));

  const LcpSolution plain = test::Solve(settings, planted.problem, start);
  const LcpSolution scaled =
      test::Solve(settings, Scaled(planted.problem, s), start.cwiseQuotient(s));
  RC_ASSERT(plain.report.sweeps == scaled.report.sweeps);
  RC_ASSERT(plain.report.factorisations == scaled.report.factorisations);
  RC_ASSERT(plain.report.stop == scaled.report.stop);
  RC_ASSERT(plain.report.residual_relative == scaled.report.residual_relative);
  RC_ASSERT(bool(test::SameBits(plain.x, scaled.x.cwiseProduct(s))));
}

// Heavier, or pushed harder. A factor of 4 is exact, and its root is.
RC_GTEST_PROP(EveryLcp, TakesTheSameWayInAnyUnits, ()) {
  const Planted planted = AnyPlanted();
  const Settings settings = AnySettings();
  const VectorXd start = AnyStart(planted.problem);
  const double of_m = *rc::gen::element(0.25, 1.0, 4096.0);
  const double of_x = *rc::gen::element(0.25, 1.0, 4096.0);
  BoxedLcp other = planted.problem;
  other.M *= of_m;
  other.q *= of_m * of_x;
  other.lo *= of_x;
  other.hi *= of_x;
  const LcpSolution plain = test::Solve(settings, planted.problem, start);
  const LcpSolution scaled = test::Solve(settings, other, of_x * start);
  RC_ASSERT(plain.report.stop == scaled.report.stop);
  RC_ASSERT(bool(test::SameBits(of_x * plain.x, scaled.x)));
}

/// Row i becomes row order[i].
BoxedLcp Permuted(const BoxedLcp& problem, const std::vector<int>& order) {
  BoxedLcp permuted = problem;
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < problem.size(); ++j) {
    for (Sparse::InnerIterator entry(problem.M, j); entry; ++entry) {
      entries.emplace_back(order[entry.row()], order[j], entry.value());
    }
    permuted.q[order[j]] = problem.q[j];
    permuted.lo[order[j]] = problem.lo[j];
    permuted.hi[order[j]] = problem.hi[j];
  }
  permuted.M.setFromTriplets(entries.begin(), entries.end());
  return permuted;
}

// Both are as near to the solution as their residuals imply, so they are near to each other.
RC_GTEST_PROP(EveryLcp, HasTheSameSolutionInAnyOrderOfItsRows, ()) {
  const Planted planted = AnyPlanted();
  const int n = static_cast<int>(planted.problem.size());
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  test::Random random = AnyRandom();
  for (int i = n; i > 1; --i) std::swap(order[i - 1], order[random.Index(i)]);

  const Settings settings =
      test::Until(*rc::gen::element(Method::kPgsSm, Method::kInteriorPoint), 1e-12);
  const LcpSolution straight = test::Solve(settings, planted.problem);
  const LcpSolution permuted = test::Solve(settings, Permuted(planted.problem, order));
  const VectorXd back = permuted.x(order);
  RC_ASSERT(bool(test::InsideBox(planted.problem, back)));
  const double residuals =
      test::MostResidual(planted.problem, straight.x) + test::MostResidual(planted.problem, back);
  RC_ASSERT(straight.report.stop == StopReason::kConverged);
  RC_ASSERT(permuted.report.stop == StopReason::kConverged);
  RC_ASSERT(test::EnergyOfX(planted.problem, straight.x - back) <=
            test::MostApart(test::ScaledSpectrum(planted.problem), residuals));
}

}  // namespace
}  // namespace cairn::lcp
