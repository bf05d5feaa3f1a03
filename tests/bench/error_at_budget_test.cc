// SPDX-License-Identifier: MIT
#include "run/output/run_output.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace cairn::cli {
namespace {

/// Curves of time [ms] and error [m/s], from the least effort on.
SolverResult Solver(std::vector<std::vector<CurvePoint>> curves) {
  SolverResult solver;
  solver.curves = std::move(curves);
  return solver;
}

TEST(ErrorAtBudget, IsThatOfTheGreatestEffortThatTookNoLonger) {
  const SolverResult solver = Solver({{{0.1, 0.5}, {0.2, 0.3}, {0.4, 0.1}}});
  EXPECT_EQ(ErrorAtBudget(solver, 0.1), 0.5);
  EXPECT_EQ(ErrorAtBudget(solver, 0.3), 0.3);
  EXPECT_EQ(ErrorAtBudget(solver, 9), 0.1);
}

// A step that solves a chain takes less time than the sweeps that a small budget is spent on.
TEST(ErrorAtBudget, OfASolverThatIsDoneIsNotThatOfLessEffort) {
  const SolverResult solver = Solver({{{0.03, 12}, {0.06, 1.3}, {0.04, 0.003}, {0.04, 0.002}}});
  EXPECT_EQ(ErrorAtBudget(solver, 2), 0.002);
  EXPECT_EQ(ErrorAtBudget(solver, 0.035), 12);
}

TEST(ErrorAtBudget, IsTheMedianOverStates) {
  const SolverResult solver = Solver({{{1, 0.1}}, {{1, 0.4}}, {{1, 0.2}}});
  EXPECT_EQ(ErrorAtBudget(solver, 1), 0.2);
}

TEST(ErrorAtBudget, IsUnknownWhereAnyStateTookLonger) {
  EXPECT_TRUE(std::isnan(ErrorAtBudget(Solver({{{1, 0.1}}, {{3, 0.1}}}), 2)));
  EXPECT_TRUE(std::isnan(ErrorAtBudget(Solver({{}}), 2)));
}

/// A scene with two solvers that were given one state.
SceneResult Scene(double bullet_error, bool bullet_stands, double cairn_error) {
  SceneResult scene;
  SolverResult bullet = Solver({{{1, bullet_error}}}), cairn = Solver({{{1, cairn_error}}});
  bullet.label = "bullet-si";
  bullet.standing = bullet_stands;
  cairn.label = "cairn";
  cairn.is_ours = true;
  scene.solvers = {bullet, cairn};
  return scene;
}

RunResult TwoMilliseconds() {
  RunResult run;
  run.budget = std::chrono::milliseconds(2);
  return run;
}

TEST(Advice, NamesTheSolverOfTheLeastError) {
  const std::string text = Advice(Scene(0.4, true, 0.1), TwoMilliseconds());
  EXPECT_NE(text.find("With 2 ms a frame use cairn: median velocity error 0.100 m/s, 4 times less "
                      "than bullet-si, the next."),
            std::string::npos)
      << text;
}

TEST(Advice, SaysWhereAnotherIsAsGood) {
  const std::string text = Advice(Scene(0.1, true, 0.3), TwoMilliseconds());
  EXPECT_NE(text.find("use bullet-si"), std::string::npos) << text;
  EXPECT_NE(text.find("Cairn does not help at 1 ms, 2 ms"), std::string::npos) << text;
}

// Below what can be seen the smaller error is not the better solver; one whose scene fell is worse.
TEST(Advice, PrefersARunThatWentWellAmongThoseThatAreAccurate) {
  const std::string text = Advice(Scene(0.00006, false, 0.0006), TwoMilliseconds());
  EXPECT_NE(text.find("use cairn"), std::string::npos) << text;
  EXPECT_NE(text.find("bullet-si is as good, both are below 0.01 m/s"), std::string::npos) << text;
  EXPECT_NE(text.find("Cairn does not help at"), std::string::npos) << text;
}

}  // namespace
}  // namespace cairn::cli
