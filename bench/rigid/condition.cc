// SPDX-License-Identifier: MIT
#include "rigid/condition.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "rigid/envelope_cholesky.h"
#include "scenes/random.h"

namespace cairn::bench {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

constexpr Eigen::Index kMostSteps = 300;
constexpr double kLeastShare = 1e-12, kMostShare = 1e3;
constexpr double kConditionError = 1e-3;  // in log, so relative

Eigen::VectorXd Start(Eigen::Index n) {
  Random random(1);
  Eigen::VectorXd start(n);
  for (double& value : start) value = random.Within(-1, 1);
  return start.normalized();
}

/// The largest Ritz value of a tridiagonal matrix, and the last entry of its vector.
struct Ritz {
  double value = 0, last_entry = 1;
};

Ritz LargestRitz(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& side) {
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen;
  eigen.computeFromTridiagonal(diagonal, side);
  const Eigen::Index last = diagonal.size() - 1;  // ascending
  return {.value = eigen.eigenvalues()[last], .last_entry = eigen.eigenvectors()(last, last)};
}

Matrix WithShare(Matrix matrix, double share) {
  for (Eigen::Index i = 0; i < matrix.cols(); ++i) matrix.coeffRef(i, i) *= 1 + share;
  return matrix;
}

}  // namespace

double LargestEigenvalue(const LinearMap& map, Eigen::Index n) {
  const Eigen::Index most = std::min(n, kMostSteps);
  Eigen::MatrixXd basis(n, most);
  Eigen::VectorXd diagonal(most), side(most);
  Eigen::VectorXd next = Start(n);
  Ritz ritz;
  for (Eigen::Index k = 0; k < most; ++k) {
    basis.col(k) = next;
    next = map(basis.col(k));
    diagonal[k] = basis.col(k).dot(next);
    const auto known = basis.leftCols(k + 1);
    // Twice is enough (Parlett, Kahan)
    for (int pass = 0; pass < 2; ++pass) next -= known * (known.transpose() * next);
    side[k] = next.norm();
    ritz = LargestRitz(diagonal.head(k + 1), side.head(k));
    if (side[k] * std::abs(ritz.last_entry) <= kEigenvalueError * ritz.value) break;
    next /= side[k];
  }
  return ritz.value;
}

Spectrum ExtremeEigenvalues(const Matrix& matrix) {
  const Eigen::Index n = matrix.cols();
  Spectrum spectrum;
  spectrum.largest =
      LargestEigenvalue([&](const Eigen::VectorXd& x) -> Eigen::VectorXd { return matrix * x; }, n);
  const EnvelopeCholesky factor(matrix);
  if (factor.ok()) {
    spectrum.smallest =
        1 / LargestEigenvalue([&](const Eigen::VectorXd& x) { return factor.Solve(x); }, n);
  }
  return spectrum;
}

Compliance FindCompliance(const Matrix& matrix, double target) {
  double low = std::log(kLeastShare), high = std::log(kMostShare);
  // A matrix that is singular without s has a condition number that goes with 1 / s
  double slope = -1, x = -std::log(target), last_x = x, last_excess = 0;
  Compliance found;
  while (high - low > kConditionError) {
    if (!(low < x && x < high)) x = (low + high) / 2;
    found.share = std::exp(x);
    found.condition = ExtremeEigenvalues(WithShare(matrix, found.share)).condition();
    const double excess = std::log(found.condition / target);
    if (std::abs(excess) <= kConditionError) break;

    (excess > 0 ? low : high) = x;
    if (x != last_x) slope = (excess - last_excess) / (x - last_x);
    last_x = x;
    last_excess = excess;
    x -= excess / slope;
  }
  return found;
}

}  // namespace cairn::bench
