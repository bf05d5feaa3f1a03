// SPDX-License-Identifier: MIT
// Making and solving generated problems, for the tests of their generators.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cairn/lcp/solver.h"
#include "problems/problem.h"

namespace cairn::problems {

inline Problem Generate(const Generator& generator, int size, const std::vector<double>& values) {
  return generator.make(size, values)->current();
}

inline Eigen::VectorXd Solved(const Problem& problem, const Eigen::VectorXd& start) {
  lcp::Solver solver({.max_sweeps = 100000, .tolerance = 1e-10, .always_solve = true});
  Eigen::VectorXd x = start.size() > 0 ? start : Eigen::VectorXd::Zero(problem.lcp.size());
  const lcp::Report report = solver.Solve(problem.lcp, &x);
  EXPECT_TRUE(report.ok()) << problem.name << ": " << Describe(report.status);
  EXPECT_LE(report.residual_relative, 1e-10) << problem.name;
  return x;
}

/// From the coarsest grid up.
inline Eigen::VectorXd SolvedFromCoarse(const Problem& problem) {
  if (!problem.coarser) return Solved(problem, {});
  return Solved(problem, problem.prolong(SolvedFromCoarse(problem.coarser())));
}

inline double Measured(const Problem& problem, const std::string& answer,
                       const Eigen::VectorXd& x) {
  for (const Answer& known : problem.answers) {
    if (known.name == answer) return known.measure(x);
  }
  ADD_FAILURE() << problem.name << " has no answer " << answer;
  return 0;
}

inline void ExpectEveryAnswer(const Problem& problem, const Eigen::VectorXd& x) {
  ASSERT_FALSE(problem.answers.empty()) << problem.name;
  for (const Answer& known : problem.answers) {
    EXPECT_NEAR(known.measure(x), known.expected, known.tolerance)
        << problem.name << ", " << known.name << ", " << known.source;
  }
}

}  // namespace cairn::problems
