// SPDX-License-Identifier: MIT
// Problems in matrix form with planted solutions, ways to solve them, and how far a solution may be
// from the truth.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "cairn/lcp/solver.h"
#include "problems.h"

namespace cairn::test {

using Sparse = Eigen::SparseMatrix<double>;

/// Diagonally dominant, about @p entries off-diagonal entries in a row: well conditioned.
Sparse DominantMatrix(int n, int entries, Random* random);
/// J J' + E: n rows between n / 2 bodies, each of them redundant but for E = compliance diag(J J').
/// @p compliance 0 makes it singular.
Sparse RedundantMatrix(int n, double compliance, Random* random);
/// The 5-point Laplacian of a square grid: 4 and -1.
Sparse StencilMatrix(int side);

lcp::BoxedLcp Boxed(const Eigen::MatrixXd& m, const Eigen::VectorXd& q, const Eigen::VectorXd& lo,
                    const Eigen::VectorXd& hi);
/// 0 <= x.
lcp::BoxedLcp Complementary(const Sparse& m, const Eigen::VectorXd& q);

/// w = (x - y - 1, y - x - 1), which cannot both be at least 0, with x and y at least 0.
lcp::BoxedLcp WithoutSolution();

/// A problem, and the x and w that it was made from: q = w - M x, rounded.
struct Planted {
  lcp::BoxedLcp problem;
  Eigen::VectorXd x, w;
};

/// Shares of rows, each in [0, 1].
struct PlantOptions {
  double unbounded = 0.2;   ///< Of all rows: equations.
  double two_sided = 0.3;   ///< Of the rows with bounds: those with both.
  double upper_only = 0.2;  ///< Of the rows with one bound.
  double active = 0.5;      ///< Of the rows with bounds: those at one.
  double degenerate = 0;    ///< Of the rows at a bound: those with w = 0.
};
Planted Plant(const Sparse& m, const PlantOptions& options, Random* random);

struct LcpSolution {
  lcp::Report report;
  Eigen::VectorXd x;
};
/// From @p start, or from zeros if that is empty.
LcpSolution Solve(lcp::Solver* solver, const lcp::BoxedLcp& problem,
                  const Eigen::VectorXd& start = {});
/// By a new solver.
LcpSolution Solve(const lcp::Settings& settings, const lcp::BoxedLcp& problem,
                  const Eigen::VectorXd& start = {});

/// So many sweeps in that order and nothing else.
lcp::Settings MatrixSweeps(int sweeps, lcp::SweepOrder order = lcp::SweepOrder::kForward);
/// Iterates until the tolerance is reached.
lcp::Settings Until(lcp::Method method, double tolerance);

/// Also tells 0 from -0, and not one NaN from the same one.
testing::AssertionResult SameBits(const Eigen::VectorXd& a, const Eigen::VectorXd& b);
/// Finite, and not a rounding outside.
testing::AssertionResult InsideBox(const lcp::BoxedLcp& problem, const Eigen::VectorXd& x);

/// sqrt(sum d_i y_i^2) and sqrt(sum y_i^2 / d_i), d = diag(M): the norms of changes of x and of w.
double EnergyOfX(const lcp::BoxedLcp& problem, const Eigen::VectorXd& y);
double EnergyOfW(const lcp::BoxedLcp& problem, const Eigen::VectorXd& y);

/// EnergyOfW() of what rounding can change in w = M x + q: each sum of k terms by k eps of the sum
/// of their absolute values.
double RoundingOfW(const lcp::BoxedLcp& problem, const Eigen::VectorXd& x);
/// LcpResidual::energy and what rounding may hide of it.
double MostResidual(const lcp::BoxedLcp& problem, const Eigen::VectorXd& x);

/// Smallest and largest eigenvalue of D^-1/2 M D^-1/2, in dense arithmetic.
struct Spectrum {
  double least, most;
};
Spectrum ScaledSpectrum(const lcp::BoxedLcp& problem);
/// A bound of the largest one that is cheap: the largest row sum of its absolute values.
double MostOfScaledSpectrum(const lcp::BoxedLcp& problem);

/// Most that two points can be apart whose natural maps r = x - clamp(x - w / d) are e and f long,
/// |r|_D = LcpResidual::energy; @p residuals is e + f. Both y = x - r are projections, so with dx,
/// dr and dy = dx - dr
///   dy' (D dr - M dx) >= 0,   hence   |dx|_M^2 <= dx' D dr + dr' M dx,   |dr|_D <= e + f.
/// With lambda the eigenvalues of D^-1 M this bounds
///   |dx|_D <= (e + f) (1 + most) / least                       where M is definite, and
///   |dw| <= sqrt(most) |dx|_M,  |dx|_M^2 <= (e + f) (|dx|_D + sqrt(most) |dx|_M)   in any case.
double MostApart(const Spectrum& spectrum, double residuals);
double MostApartInW(double most, double residuals, double apart_in_x);

}  // namespace cairn::test
