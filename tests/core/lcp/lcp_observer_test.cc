// SPDX-License-Identifier: MIT
// What an observer of a problem in matrix form sees, and what it can do.
#include <gtest/gtest.h>

#include <vector>

#include "tests/core/support/lcp_problems.h"

namespace cairn::lcp {
namespace {

using Eigen::VectorXd;
using test::LcpSolution;
using test::Planted;

Planted AnyPlanted(std::uint64_t seed) {
  test::Random random(seed);
  return test::Plant(test::RedundantMatrix(80, 1e-3, &random), {.degenerate = 0.1}, &random);
}

const Method kMethods[] = {Method::kPgs, Method::kPsor, Method::kPgsSm, Method::kPgsSmLiteral,
                           Method::kInteriorPoint};

struct Shown {
  VectorXd x;
  int sweeps, factorisations;
};

/// Solves, and keeps all that was shown.
LcpSolution SolveWatched(const Settings& settings, const BoxedLcp& problem,
                         std::vector<Shown>* all) {
  Solver solver(settings);
  solver.Observe([all](const Iterate& iterate) {
    all->push_back({iterate.x, iterate.sweeps, iterate.factorisations});
    return true;
  });
  return test::Solve(&solver, problem);
}

// The start, and then the iterate after each sweep.
TEST(Observer, SeesEverySweep) {
  const Planted planted = AnyPlanted(1);
  std::vector<Shown> all;
  const LcpSolution s = SolveWatched(test::MatrixSweeps(12), planted.problem, &all);
  ASSERT_EQ(all.size(), 13u);
  for (int k = 0; k <= 12; ++k) {
    EXPECT_EQ(all[k].sweeps, k);
    EXPECT_EQ(all[k].factorisations, 0);
    EXPECT_TRUE(test::SameBits(all[k].x, test::Solve(test::MatrixSweeps(k), planted.problem).x));
  }
  EXPECT_TRUE(test::SameBits(all.back().x, s.x));
}

TEST(Observer, SeesIteratesInsideTheBoxAndCountsThatGrow) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Planted planted = AnyPlanted(seed);
    for (const Method method : kMethods) {
      SCOPED_TRACE(static_cast<int>(method));
      Settings settings = test::Until(method, 1e-9);
      settings.max_sweeps = 300;
      std::vector<Shown> all;
      const LcpSolution s = SolveWatched(settings, planted.problem, &all);
      int sweeps = 0, factorisations = 0;
      for (const Shown& shown : all) {
        EXPECT_TRUE(test::InsideBox(planted.problem, shown.x));
        EXPECT_GE(shown.sweeps, sweeps);
        EXPECT_LE(shown.sweeps, sweeps + 1);
        EXPECT_GE(shown.factorisations, factorisations);
        sweeps = shown.sweeps;
        factorisations = shown.factorisations;
      }
      EXPECT_EQ(sweeps, s.report.sweeps);
      EXPECT_EQ(factorisations, s.report.factorisations);
      EXPECT_GE(all.size(), static_cast<size_t>(s.report.sweeps));
    }
  }
}

TEST(Observer, ChangesNotABit) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Planted planted = AnyPlanted(seed);
    for (const Method method : kMethods) {
      Settings settings = test::Until(method, 1e-9);
      settings.max_sweeps = 300;
      std::vector<Shown> all;
      const LcpSolution watched = SolveWatched(settings, planted.problem, &all);
      const LcpSolution alone = test::Solve(settings, planted.problem);
      EXPECT_TRUE(test::SameBits(watched.x, alone.x));
      EXPECT_EQ(watched.report.sweeps, alone.report.sweeps);
      EXPECT_EQ(watched.report.work, alone.report.work);
    }
  }
}

// Cancelled at its k-th call: nothing more is done than what was shown, and x is the best of that.
TEST(Observer, EndsTheIterationWhenItSaysSo) {
  const Planted planted = AnyPlanted(6);
  for (const Method method : kMethods) {
    for (int last = 1; last <= 12; ++last) {
      SCOPED_TRACE(testing::Message() << static_cast<int>(method) << " at " << last);
      Solver solver(test::Until(method, 1e-15));
      int calls = 0, sweeps = 0, factorisations = 0;
      solver.Observe([&](const Iterate& iterate) {
        sweeps = iterate.sweeps;
        factorisations = iterate.factorisations;
        return ++calls < last;
      });
      const LcpSolution s = test::Solve(&solver, planted.problem);
      if (s.report.stop == StopReason::kStalled || s.report.stop == StopReason::kConverged) {
        EXPECT_LT(calls, last);
        continue;
      }
      EXPECT_TRUE(s.report.ok());
      EXPECT_EQ(s.report.stop, StopReason::kCancelled);
      EXPECT_EQ(calls, last);
      EXPECT_EQ(s.report.sweeps, sweeps);
      EXPECT_EQ(s.report.factorisations, factorisations);
      EXPECT_TRUE(test::InsideBox(planted.problem, s.x));
      EXPECT_EQ(s.report.residual_relative, Measure(planted.problem, s.x).relative);
    }
  }
}

TEST(Observer, ThatIsEmptySeesNothing) {
  const Planted planted = AnyPlanted(7);
  Solver solver;
  int calls = 0;
  solver.Observe([&calls](const Iterate&) {
    ++calls;
    return true;
  });
  (void)test::Solve(&solver, planted.problem);
  const int before = calls;
  EXPECT_GT(before, 0);
  solver.Observe({});
  (void)test::Solve(&solver, planted.problem);
  EXPECT_EQ(calls, before);
}

// It belongs to the caller, not to what the solver learnt.
TEST(Observer, StaysWhenTheSolverForgets) {
  const Planted planted = AnyPlanted(8);
  Solver solver;
  int calls = 0;
  solver.Observe([&calls](const Iterate&) {
    ++calls;
    return true;
  });
  solver.Reset();
  (void)test::Solve(&solver, planted.problem);
  EXPECT_GT(calls, 0);
}

TEST(Observer, IsNotCalledForAProblemThatIsRefused) {
  Planted planted = AnyPlanted(9);
  planted.problem.M.coeffRef(3, 3) = -1;
  Solver solver;
  solver.Observe([](const Iterate&) {
    ADD_FAILURE() << "called";
    return true;
  });
  EXPECT_EQ(test::Solve(&solver, planted.problem).report.status, Status::kBadDiagonal);
}

}  // namespace
}  // namespace cairn::lcp
