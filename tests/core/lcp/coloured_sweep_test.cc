// SPDX-License-Identifier: MIT
// Sweeps by colour, and the threads that share them.
#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <vector>

#include "core/lcp/src/methods/matrix_sweep.h"
#include "runtime/own_threads.h"
#include "tests/core/support/lcp_problems.h"

namespace cairn::lcp {
namespace {

using Eigen::VectorXd;

/// A membrane on side x side points, with a load that leaves some of them at the bound.
BoxedLcp Membrane(int side) {
  return test::Complementary(test::StencilMatrix(side), VectorXd::LinSpaced(side * side, -1, 1));
}

Settings Coloured(int threads) {
  Settings settings;
  settings.method = Method::kPgs;
  settings.order = SweepOrder::kColoured;
  settings.threads = threads;
  settings.max_sweeps = 30;
  settings.tolerance = 0;
  return settings;
}

TEST(ColourRows, GivesRowsThatShareAnEntryDifferentColours) {
  test::Random random(1);
  for (const auto& m : {Membrane(13).M, test::RedundantMatrix(80, 1e-3, &random)}) {
    const std::vector<int> colours = ColourRows(m, static_cast<int>(m.cols()));
    ASSERT_EQ(static_cast<int>(colours.size()), m.cols());
    for (int j = 0; j < m.cols(); ++j) {
      for (Eigen::SparseMatrix<double>::InnerIterator entry(m, j); entry; ++entry) {
        EXPECT_TRUE(entry.row() == j || colours[entry.row()] != colours[j]);
      }
    }
  }
}

TEST(ColourRows, NeedsTwoColoursForAStencilAndGivesUpBeyondTheMost) {
  const std::vector<int> colours = ColourRows(Membrane(9).M, 2);
  ASSERT_EQ(colours.size(), 81u);
  for (int i = 0; i < 81; ++i) EXPECT_EQ(colours[i], (i / 9 + i % 9) % 2);
  EXPECT_TRUE(ColourRows(Membrane(9).M, 1).empty());
}

// 150 x 150 points are two colours of eleven blocks each: more than the threads.
TEST(ColouredSweeps, GiveTheSameBitsForAnyNumberOfThreads) {
  const BoxedLcp problem = Membrane(150);
  VectorXd expected = VectorXd::Zero(problem.size());
  ASSERT_TRUE(Solver(Coloured(1)).Solve(problem, &expected).ok());
  for (const int threads : {2, 3, 8}) {
    for (int repetition = 0; repetition < 5; ++repetition) {
      VectorXd x = VectorXd::Zero(problem.size());
      ASSERT_TRUE(Solver(Coloured(threads)).Solve(problem, &x).ok());
      EXPECT_TRUE(test::SameBits(x, expected)) << threads << " threads";
    }
  }
}

// Colour by colour, by hand: even points from the start, odd points from the even ones.
TEST(ColouredSweeps, RelaxOneColourAfterTheOther) {
  const BoxedLcp problem = Membrane(3);
  Settings settings = Coloured(1);
  settings.max_sweeps = 1;
  VectorXd x = VectorXd::Zero(9);
  ASSERT_TRUE(Solver(settings).Solve(problem, &x).ok());

  VectorXd expected = VectorXd::Zero(9);
  for (const int colour : {0, 1}) {
    for (int i = 0; i < 9; ++i) {
      if (i % 2 != colour) continue;
      const double rest = problem.M.col(i).dot(expected) - 4 * expected[i] + problem.q[i];
      expected[i] = std::max(0.0, -rest / 4);
    }
  }
  EXPECT_LE((x - expected).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(ColouredSweeps, AreChosenForLargeStencilsOnly) {
  for (const auto& [side, same] : {std::pair(100, false), std::pair(145, true)}) {
    const BoxedLcp problem = Membrane(side);
    Settings settings = Coloured(1);
    settings.max_sweeps = 3;
    VectorXd coloured = VectorXd::Zero(problem.size()), automatic = coloured;
    ASSERT_TRUE(Solver(settings).Solve(problem, &coloured).ok());
    settings.order = SweepOrder::kAutomatic;
    ASSERT_TRUE(Solver(settings).Solve(problem, &automatic).ok());
    EXPECT_EQ(test::SameBits(coloured, automatic), same) << side;
  }
}

}  // namespace
}  // namespace cairn::lcp
