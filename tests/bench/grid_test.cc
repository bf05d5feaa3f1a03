// SPDX-License-Identifier: MIT
#include "problems/grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "problems/bearings/film.h"

namespace cairn::problems {
namespace {

using Eigen::VectorXd;

constexpr double kInf = std::numeric_limits<double>::infinity();

// Two by two points of a square of side 3, h = 1: all conductances are one. By hand.
TEST(Grid, FillsTheFivePointMatrixOfASquare) {
  const Grid grid = {.nx = 2, .ny = 2, .lx = 3, .ly = 3};
  const Eigen::MatrixXd m = FivePointMatrix(grid, Membrane(grid, 1));
  Eigen::Matrix4d expected;
  expected << 4, -1, -1, 0, -1, 4, 0, -1, -1, 0, 4, -1, 0, -1, -1, 4;
  EXPECT_EQ(m, expected);

  const Field x_plus_one = [](double x, double) { return x + 1; };
  // West x = 0, east x = 3, and below and above the points at x = 1 and 2.
  EXPECT_EQ(BoundaryLoad(grid, Membrane(grid, 1), x_plus_one), Eigen::Vector4d(-3, -7, -3, -7));
}

// Three by one points with edges of conductance 1, 2, 3, 4 along and 10 + i below, 20 + i above.
TEST(Grid, PutsEachConductanceWhereItsEdgeIs) {
  const Grid grid = {.nx = 3, .ny = 1};
  const Conductance k = {.east = [](int i, int) { return i + 2.0; },
                         .north = [](int i, int j) { return (j < 0 ? 10.0 : 20.0) + i; }};
  Eigen::Matrix3d expected;
  expected << 1 + 2 + 30, -2, 0, -2, 2 + 3 + 32, -3, 0, -3, 3 + 4 + 34;
  EXPECT_EQ(Eigen::MatrixXd(FivePointMatrix(grid, k)), expected);
}

// A harmonic function that the 5-point formula meets exactly: M u + q = 0.
TEST(Grid, SolvesALinearFieldExactly) {
  const Grid grid = {.nx = 5, .ny = 8, .x0 = -1, .y0 = 2, .lx = 3, .ly = 4};
  const Field field = [](double x, double y) { return 2 + 3 * x - y + x * y; };
  const Conductance k = Membrane(grid, 1);
  const VectorXd w = FivePointMatrix(grid, k) * Sample(grid, field) + BoundaryLoad(grid, k, field);
  EXPECT_LT(w.lpNorm<Eigen::Infinity>(), 1e-13);  // sums of 5 numbers below 100
}

TEST(Grid, KeepsNoRoomBesideTheMatrix) {
  const Grid grid = {.nx = 40, .ny = 30};
  const auto m = FivePointMatrix(grid, Membrane(grid, 1));
  EXPECT_TRUE(m.isCompressed());
  EXPECT_EQ(m.nonZeros(), 5 * 40 * 30 - 2 * 40 - 2 * 30);
  EXPECT_EQ(m.data().allocatedSize(), m.nonZeros());
}

/// Coarse and fine points per side: nested and not, odd and even, and the smallest.
constexpr std::pair<int, int> kLevels[] = {{3, 7}, {4, 8}, {5, 11}, {7, 10}, {1, 2},
                                           {2, 4}, {2, 5}, {9, 9},  {10, 3}, {50, 100}};

TEST(Prolong, KeepsConstantsAndBilinearFields) {
  const Box constant = {Constant(-kInf), Constant(kInf), Constant(0.7)};
  const Field bilinear = [](double x, double y) { return 1 + 2 * x - 3 * y + 4 * x * y; };
  const Box open = {Constant(-kInf), Constant(kInf), bilinear};
  for (const auto& [from, to] : kLevels) {
    SCOPED_TRACE(std::to_string(from) + " to " + std::to_string(to));
    const Grid coarse = {.nx = from, .ny = to, .lx = 2}, fine = {.nx = to, .ny = from, .lx = 2};
    const VectorXd flat = Prolong(coarse, fine, constant, VectorXd::Constant(coarse.size(), 0.7));
    // Four weights that add up to one but for rounding.
    EXPECT_LT((flat.array() - 0.7).abs().maxCoeff(), 1e-15);
    const VectorXd curved = Prolong(coarse, fine, open, Sample(coarse, bilinear));
    EXPECT_LT((curved - Sample(fine, bilinear)).lpNorm<Eigen::Infinity>(), 2e-14);
  }
}

TEST(Prolong, MeetsTheCoarsePointsOfANestedGridExactly) {
  const Grid coarse = {.nx = 6, .ny = 4}, fine = {.nx = 13, .ny = 9};
  const VectorXd x = Sample(coarse, [](double a, double b) { return std::sin(7 * a + b) + 1; });
  const VectorXd start = Prolong(coarse, fine, PressureBox(), x);
  for (int j = 0; j < coarse.ny; ++j) {
    for (int i = 0; i < coarse.nx; ++i) {
      EXPECT_EQ(start[fine.row(2 * i + 1, 2 * j + 1)], x[coarse.row(i, j)]);
    }
  }
}

// The left half of the coarse points is zero. A fine point is zero exactly if it does not lie
// beyond the last column of zeros.
TEST(Prolong, CarriesTheZeroSetOver) {
  for (const auto& [from, to] : kLevels) {
    SCOPED_TRACE(std::to_string(from) + " to " + std::to_string(to));
    const Grid coarse = {.nx = from, .ny = from}, fine = {.nx = to, .ny = to};
    const int last = from / 2;
    VectorXd x = VectorXd::Ones(coarse.size());
    for (int j = 0; j < from; ++j) x.segment(coarse.row(0, j), last + 1).setZero();
    const VectorXd start = Prolong(coarse, fine, PressureBox(), x);
    for (int j = 0; j < to; ++j) {
      for (int i = 0; i < to; ++i) {
        const bool zero = (i + 1) * (from + 1) <= (last + 1) * (to + 1) || last + 1 == from;
        EXPECT_EQ(start[fine.row(i, j)] == 0, zero) << i << " " << j;
      }
    }
  }
}

// Where all coarse neighbours touch a bound, so does the fine point, though the bound is curved.
TEST(Prolong, KeepsContactWithCurvedBoundsAndStaysInside) {
  const Box box = {[](double x, double y) { return x * x + y; },
                   [](double x, double y) { return x * x + y + 0.01; }, Constant(0)};
  const Grid coarse = {.nx = 7, .ny = 7}, fine = {.nx = 16, .ny = 15};
  const VectorXd lo = Sample(fine, box.lo), hi = Sample(fine, box.hi);
  EXPECT_EQ(Prolong(coarse, fine, box, Sample(coarse, box.lo)), lo);
  EXPECT_EQ(Prolong(coarse, fine, box, Sample(coarse, box.hi)), hi);
  const VectorXd mixed =
      Prolong(coarse, fine, box, (Sample(coarse, box.lo) + Sample(coarse, box.hi)) / 2);
  EXPECT_TRUE((mixed.array() >= lo.array()).all() && (mixed.array() <= hi.array()).all());
}

TEST(ObjectiveAnswer, IsHalfTheQuadraticPlusTheLinearTerm) {
  const Grid line = {.nx = 2, .ny = 1, .lx = 3};
  BoxedLcp lcp = FilmLcp(line, [](double) { return 1.0; });  // M = [2 -1; -1 2]
  lcp.q = Eigen::Vector2d(1, -5);
  const Answer answer = ObjectiveAnswer(lcp, 0, 0, "by hand");
  // 1/2 (2 9 - 2 12 + 2 16) + 3 - 20
  EXPECT_NEAR(answer.measure(Eigen::Vector2d(3, 4)), -4, 1e-14);
}

TEST(ShortestText, ReadsBack) {
  EXPECT_EQ(ShortestText(0.1), "0.1");
  EXPECT_EQ(ShortestText(5), "5");
  EXPECT_EQ(std::stod(ShortestText(1.0 / 3)), 1.0 / 3);
}

}  // namespace
}  // namespace cairn::problems
