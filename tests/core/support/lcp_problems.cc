// SPDX-License-Identifier: MIT
#include "lcp_problems.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "cairn/contact_problem.h"

namespace cairn::test {
namespace {

Eigen::VectorXd Zeros(Eigen::Index n) { return Eigen::VectorXd::Zero(n); }
Eigen::VectorXd Infinite(Eigen::Index n) { return Eigen::VectorXd::Constant(n, kInfinity); }

Sparse FromTriplets(int n, const std::vector<Eigen::Triplet<double>>& entries) {
  Sparse m(n, n);
  m.setFromTriplets(entries.begin(), entries.end());
  return m;
}

/// Where row i is at the solution.
enum class Place { kInside, kLower, kUpper };

Place AnyPlace(const PlantOptions& options, double lo, double hi, Random* random) {
  if (random->Uniform(0, 1) >= options.active) return Place::kInside;
  if (std::isinf(lo)) return std::isinf(hi) ? Place::kInside : Place::kUpper;
  return std::isinf(hi) || random->Index(2) == 0 ? Place::kLower : Place::kUpper;
}

/// Bounds of both signs about a random point.
void AnyBounds(const PlantOptions& options, Random* random, double* lo, double* hi) {
  *lo = -kInfinity;
  *hi = kInfinity;
  if (random->Uniform(0, 1) < options.unbounded) return;
  const double middle = random->Uniform(-1, 1), half = random->Uniform(0.1, 1);
  const bool both = random->Uniform(0, 1) < options.two_sided;
  const bool upper = random->Uniform(0, 1) < options.upper_only;
  if (both || !upper) *lo = middle - half;
  if (both || upper) *hi = middle + half;
}

/// A point between the bounds and well away from them.
double AnyInside(double lo, double hi, Random* random) {
  const double share = random->Uniform(0.2, 0.8);
  if (std::isfinite(lo) && std::isfinite(hi)) return lo + share * (hi - lo);
  if (std::isfinite(lo)) return lo + share;
  return std::isfinite(hi) ? hi - share : 2 * share - 1;
}

}  // namespace

Sparse DominantMatrix(int n, int entries, Random* random) {
  std::vector<Eigen::Triplet<double>> triplets;
  Eigen::VectorXd sums = Eigen::VectorXd::Constant(n, 0.1);
  for (int k = 0; n > 1 && k < n * entries / 2; ++k) {
    const int i = random->Index(n), j = (i + 1 + random->Index(n - 1)) % n;
    const double value = random->Uniform(-1, 1);
    triplets.emplace_back(i, j, value);
    triplets.emplace_back(j, i, value);
    sums[i] += 1.5 * std::abs(value);
    sums[j] += 1.5 * std::abs(value);
  }
  for (int i = 0; i < n; ++i) triplets.emplace_back(i, i, sums[i]);
  return FromTriplets(n, triplets);
}

Sparse RedundantMatrix(int n, double compliance, Random* random) {
  const int bodies = std::max(1, n / 2);
  std::vector<Eigen::Triplet<double>> triplets;
  for (int i = 0; i < n; ++i) {
    triplets.emplace_back(i, i % bodies, random->Uniform(0.5, 2));
    if (bodies > 1) triplets.emplace_back(i, (i + 1) % bodies, random->Uniform(-2, -0.5));
  }
  Sparse j(n, bodies);
  j.setFromTriplets(triplets.begin(), triplets.end());
  const Eigen::MatrixXd dense = Eigen::MatrixXd(j) * Eigen::MatrixXd(j).transpose();

  Sparse m = dense.sparseView();
  for (int i = 0; i < n; ++i) m.coeffRef(i, i) *= 1 + compliance;
  return m;
}

Sparse StencilMatrix(int side) {
  std::vector<Eigen::Triplet<double>> triplets;
  for (int i = 0; i < side * side; ++i) {
    triplets.emplace_back(i, i, 4);
    for (int next : {i % side + 1 < side ? i + 1 : -1, i + side < side * side ? i + side : -1}) {
      if (next < 0) continue;
      triplets.emplace_back(i, next, -1);
      triplets.emplace_back(next, i, -1);
    }
  }
  return FromTriplets(side * side, triplets);
}

lcp::BoxedLcp Boxed(const Eigen::MatrixXd& m, const Eigen::VectorXd& q, const Eigen::VectorXd& lo,
                    const Eigen::VectorXd& hi) {
  lcp::BoxedLcp problem{.M = m.sparseView(), .q = q, .lo = lo, .hi = hi};
  problem.M.makeCompressed();
  return problem;
}

lcp::BoxedLcp Complementary(const Sparse& m, const Eigen::VectorXd& q) {
  return {.M = m, .q = q, .lo = Zeros(q.size()), .hi = Infinite(q.size())};
}

lcp::BoxedLcp WithoutSolution() {
  Eigen::Matrix2d m;
  m << 1, -1, -1, 1;
  return Complementary(m.sparseView(), Eigen::Vector2d(-1, -1));
}

Planted Plant(const Sparse& m, const PlantOptions& options, Random* random) {
  const Eigen::Index n = m.rows();
  Planted planted{.problem = {.M = m, .q = Zeros(n), .lo = Zeros(n), .hi = Zeros(n)},
                  .x = Zeros(n),
                  .w = Zeros(n)};
  const Eigen::VectorXd diagonal = m.diagonal();
  for (Eigen::Index i = 0; i < n; ++i) {
    double &lo = planted.problem.lo[i], &hi = planted.problem.hi[i];
    AnyBounds(options, random, &lo, &hi);
    const Place place = AnyPlace(options, lo, hi, random);
    planted.x[i] = AnyInside(lo, hi, random);
    if (place == Place::kInside) continue;
    planted.x[i] = place == Place::kLower ? lo : hi;
    if (random->Uniform(0, 1) < options.degenerate) continue;
    planted.w[i] = random->Uniform(0.1, 1) * diagonal[i] * (place == Place::kLower ? 1 : -1);
  }
  planted.problem.q = planted.w - m * planted.x;
  return planted;
}

LcpSolution Solve(lcp::Solver* solver, const lcp::BoxedLcp& problem, const Eigen::VectorXd& start) {
  LcpSolution solution;
  solution.x = start.size() == 0 ? Zeros(problem.size()) : start;
  solution.report = solver->Solve(problem, &solution.x);
  return solution;
}

LcpSolution Solve(const lcp::Settings& settings, const lcp::BoxedLcp& problem,
                  const Eigen::VectorXd& start) {
  lcp::Solver solver(settings);
  return Solve(&solver, problem, start);
}

lcp::Settings MatrixSweeps(int sweeps, lcp::SweepOrder order) {
  return {.method = lcp::Method::kPgs, .order = order, .max_sweeps = sweeps, .tolerance = 0};
}

lcp::Settings Until(lcp::Method method, double tolerance) {
  return {.method = method, .max_sweeps = 1'000'000, .tolerance = tolerance};
}

testing::AssertionResult SameBits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  if (a.size() != b.size()) return testing::AssertionFailure() << "other sizes";
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    if (std::memcmp(&a[i], &b[i], sizeof(double)) == 0) continue;
    return testing::AssertionFailure() << "row " << i << ": " << a[i] << " and " << b[i];
  }
  return testing::AssertionSuccess();
}

testing::AssertionResult InsideBox(const lcp::BoxedLcp& problem, const Eigen::VectorXd& x) {
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (std::isfinite(x[i]) && x[i] >= problem.lo[i] && x[i] <= problem.hi[i]) continue;
    return testing::AssertionFailure()
           << "row " << i << ": " << x[i] << " in " << problem.lo[i] << ".." << problem.hi[i];
  }
  return testing::AssertionSuccess();
}

double EnergyOfX(const lcp::BoxedLcp& problem, const Eigen::VectorXd& y) {
  const Eigen::VectorXd diagonal = problem.M.diagonal();
  return std::sqrt((diagonal.array() * y.array().square()).sum());
}

double EnergyOfW(const lcp::BoxedLcp& problem, const Eigen::VectorXd& y) {
  const Eigen::VectorXd diagonal = problem.M.diagonal();
  return std::sqrt((y.array().square() / diagonal.array()).sum());
}

double RoundingOfW(const lcp::BoxedLcp& problem, const Eigen::VectorXd& x) {
  Eigen::VectorXd most(x.size());
  for (int i = 0; i < x.size(); ++i) {
    double sum = std::abs(problem.q[i]), terms = 4;
    for (Sparse::InnerIterator entry(problem.M, i); entry; ++entry) {
      sum += std::abs(entry.value() * x[entry.row()]);
      ++terms;
    }
    most[i] = terms * std::numeric_limits<double>::epsilon() * sum;
  }
  return EnergyOfW(problem, most);
}

double MostResidual(const lcp::BoxedLcp& problem, const Eigen::VectorXd& x) {
  return Measure(problem, x).energy + RoundingOfW(problem, x);
}

Spectrum ScaledSpectrum(const lcp::BoxedLcp& problem) {
  const Eigen::VectorXd diagonal = problem.M.diagonal();
  const Eigen::VectorXd root = diagonal.cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = root.asDiagonal() * Eigen::MatrixXd(problem.M) * root.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled, Eigen::EigenvaluesOnly);
  return {solver.eigenvalues().minCoeff(), solver.eigenvalues().maxCoeff()};
}

double MostOfScaledSpectrum(const lcp::BoxedLcp& problem) {
  const Eigen::VectorXd diagonal = problem.M.diagonal();
  double most = 0;
  for (int j = 0; j < problem.M.cols(); ++j) {
    double sum = 0;
    for (Sparse::InnerIterator entry(problem.M, j); entry; ++entry) {
      sum += std::abs(entry.value()) / std::sqrt(diagonal[entry.row()] * diagonal[j]);
    }
    most = std::max(most, sum);
  }
  return most;
}

double MostApart(const Spectrum& spectrum, double residuals) {
  return residuals * (1 + spectrum.most) / spectrum.least;
}

double MostApartInW(double most, double residuals, double apart_in_x) {
  const double half = 0.5 * residuals * std::sqrt(most);
  return std::sqrt(most) * (half + std::sqrt(half * half + residuals * apart_in_x));
}

}  // namespace cairn::test
