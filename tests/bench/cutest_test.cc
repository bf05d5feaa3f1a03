// SPDX-License-Identifier: MIT
// CUTEst's own instances, with solutions certified in extended precision. They leave the boundary
// out and are written in v >= 0 with x = offset + sign v, where all upper or all lower bounds are
// out of reach.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>

#include "cairn/mixed_lcp.h"
#include "generated.h"
#include "problems/generators.h"
#include "problems/grid.h"
#include "problems/problem_folder.h"

namespace cairn::problems {
namespace {

namespace fs = std::filesystem;
using Eigen::VectorXd;

enum class Order { kAsHere, kTransposed };

struct Instance {
  std::string name;
  Order order = Order::kAsHere;
  double sign = 1;
};

/// In CAIRN_PROBLEMS, or in ../shared/problems beside the repository.
fs::path FolderOf(const std::string& name) {
  const char* set = std::getenv("CAIRN_PROBLEMS");
  const fs::path root =
      set != nullptr ? fs::path(set) : fs::path(CAIRN_SOURCE_DIR).parent_path() / "shared/problems";
  return root / "open" / name;
}

/// Place of each of their rows in a square grid of ours.
Eigen::PermutationMatrix<Eigen::Dynamic> Places(Eigen::Index n, Order order) {
  const int side = static_cast<int>(std::lround(std::sqrt(static_cast<double>(n))));
  Eigen::PermutationMatrix<Eigen::Dynamic> places(n);
  for (int i = 0; i < n; ++i) {
    places.indices()[i] = order == Order::kAsHere ? i : i % side * side + i / side;
  }
  return places;
}

double Largest(const Eigen::SparseMatrix<double>& m) { return m.coeffs().abs().maxCoeff(); }

/// Entry by entry, to a few roundings of the formulas of M and q.
constexpr double kSame = 2e-14;

void ExpectSameMatrix(const BoxedLcp& ours, const Problem& theirs, const Instance& instance) {
  const auto places = Places(ours.size(), instance.order);
  Eigen::SparseMatrix<double> m;
  m = theirs.lcp.M.twistedBy(places);
  ASSERT_EQ(m.nonZeros(), ours.M.nonZeros());
  EXPECT_LE(Largest(m - ours.M), kSame * Largest(ours.M));
}

/// Their q, bounds and solution in our order and our x. Checks q and the bounds on the way.
VectorXd ExpectSameVectors(const BoxedLcp& ours, const Problem& theirs, const Instance& instance) {
  const auto places = Places(ours.size(), instance.order);
  VectorXd offset = VectorXd::Zero(ours.size());
  if (const auto file = FolderOf(instance.name) / "offset.mtx"; fs::exists(file)) {
    offset = places * ReadVector(file);
    const VectorXd& bound = instance.sign > 0 ? ours.lo : ours.hi;
    EXPECT_LE((offset - bound).lpNorm<Eigen::Infinity>(), kSame);
  } else {
    EXPECT_LE((places * theirs.lcp.lo - ours.lo).lpNorm<Eigen::Infinity>(), kSame);
    EXPECT_LE((places * theirs.lcp.hi - ours.hi).lpNorm<Eigen::Infinity>(), kSame);
  }
  // sign (M (offset + sign v) + q) = M v + sign (M offset + q)
  const VectorXd q = instance.sign * (ours.M * offset + ours.q);
  EXPECT_LE((places * theirs.lcp.q - q).lpNorm<Eigen::Infinity>(),
            kSame * (Largest(ours.M) * offset.lpNorm<Eigen::Infinity>() +
                     ours.q.lpNorm<Eigen::Infinity>()));
  return offset + instance.sign * (places * theirs.solution);
}

/// How large the residual of an exact solution looks: each row of M x + q is a sum of six numbers,
/// none above d_i |x|, and q is small beside them.
double Rounding(const BoxedLcp& lcp, const VectorXd& x) {
  const Eigen::ArrayXd d = lcp.M.diagonal().array();
  const double q = std::sqrt((lcp.q.array().square() / d).sum());
  return 8 * std::numeric_limits<double>::epsilon() * std::sqrt(d.sum()) *
         x.lpNorm<Eigen::Infinity>() / q;
}

void ExpectSolution(const Problem& ours, const VectorXd& x) {
  EXPECT_LT(Measure(ours.lcp, x).relative, Rounding(ours.lcp, x));
  ExpectEveryAnswer(ours, x);
  // In the norm of d = diag(M) an error is at most (1 + |D^-1 M|) |(D^-1 M)^-1| times the residual,
  // which is 1e-10 of |q|. |D^-1 M| < 2, as for every 5-point matrix; |(D^-1 M)^-1| is at most the
  // largest d_i over the smallest eigenvalue of M: 4 / 0.0019 for membranes, 17.8 / 0.0070 for the
  // bearing, whose d_i are below its largest eigenvalue.
  const Eigen::ArrayXd d = ours.lcp.M.diagonal().array();
  const double q = std::sqrt((ours.lcp.q.array().square() / d).sum());
  const VectorXd error = SolvedFromCoarse(ours) - x;
  EXPECT_LT(std::sqrt((d * error.array().square()).sum()), 3 * 3e3 * 1e-10 * q);
}

void CompareWithCutest(const Problem& ours, const Instance& instance) {
  const Problem theirs = ReadProblemFolder(FolderOf(instance.name));
  ASSERT_EQ(theirs.lcp.size(), ours.lcp.size());
  ASSERT_GT(theirs.solution.size(), 0);
  ExpectSameMatrix(ours.lcp, theirs, instance);
  ExpectSolution(ours, ExpectSameVectors(ours.lcp, theirs, instance));
}

class Cutest : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(FolderOf("sif-TORSION1-37"))) {
      GTEST_SKIP() << "no CUTEst instances in " << FolderOf("")
                   << ": set CAIRN_PROBLEMS to the folder that holds open/";
    }
  }
};

TEST_F(Cutest, JournalBearing1IsOurs) {
  CompareWithCutest(Generate(JournalBearing(), 73, {0.1}),
                    {.name = "sif-JNLBRNG1-75", .order = Order::kTransposed});
}

TEST_F(Cutest, ObstacleAIsOurs) {
  CompareWithCutest(Generate(TwoSidedObstacle(), 98, {0, 1}), {.name = "sif-OBSTCLAE-100"});
}

TEST_F(Cutest, ObstacleBIsOurs) {
  CompareWithCutest(Generate(TwoSidedObstacle(), 73, {1, 1}), {.name = "sif-OBSTCLBM-75"});
}

TEST_F(Cutest, Torsion1IsOurs) {
  CompareWithCutest(Generate(Torsion(), 72, {5}), {.name = "sif-TORSION1-37", .sign = -1});
}

TEST_F(Cutest, Torsion6IsOurs) {
  CompareWithCutest(Generate(Torsion(), 72, {20}), {.name = "sif-TORSION6-37", .sign = -1});
}

// JNLBRNGA is no discretisation of the bearing: where JNLBRNG1 adds 2 p(x) and p at a neighbour, it
// multiplies them, and it sums over interior points only. Still a matrix of conductances.
TEST_F(Cutest, JournalBearingAIsAGridOfConductances) {
  constexpr int kSide = 73;
  const Grid grid = {.nx = kSide, .ny = kSide, .lx = 6.2831853, .ly = 20};
  const auto p = [&](int i) { return std::pow(1 + 0.1 * std::cos(grid.x(i)), 3); };
  const double slender = grid.hy() / grid.hx(), twelfth = 0.0833333333;
  // Twice the weight of a square, from either end that is inside.
  const auto weight = [&](int i, int neighbour) { return 4 * twelfth * p(i) * p(neighbour); };
  const Conductance k = {.east =
                             [&](int i, int) {
                               const int ends = (i >= 0) + (i + 1 < kSide);
                               return ends * weight(i, i + 1) * slender;
                             },
                         .north =
                             [&](int i, int j) {
                               const double lower = j >= 0 ? weight(i, i + 1) : 0;
                               const double upper = j + 1 < kSide ? weight(i, i - 1) : 0;
                               return (lower + upper) / slender;
                             }};
  BoxedLcp lcp;
  lcp.M = FivePointMatrix(grid, k);
  lcp.q =
      Sample(grid, [&](double x, double) { return -0.1 * grid.hx() * grid.hy() * std::sin(x); });
  lcp.lo = VectorXd::Zero(lcp.size());
  lcp.hi = VectorXd::Constant(lcp.size(), std::numeric_limits<double>::infinity());

  const Instance instance = {.name = "sif-JNLBRNGA-75", .order = Order::kTransposed};
  const Problem theirs = ReadProblemFolder(FolderOf(instance.name));
  ASSERT_EQ(theirs.lcp.size(), lcp.size());
  ExpectSameMatrix(lcp, theirs, instance);
  const VectorXd x = ExpectSameVectors(lcp, theirs, instance);
  EXPECT_LT(Measure(lcp, x).relative, 1e-12);
}

}  // namespace
}  // namespace cairn::problems
