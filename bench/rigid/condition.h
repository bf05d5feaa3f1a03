// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCore>
#include <functional>

namespace cairn::bench {

/// A symmetric positive definite linear map of vectors with n entries.
using LinearMap = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

/// Relative: a tenth of the per cent to which condition numbers are wanted.
inline constexpr double kEigenvalueError = 1e-3;

/// Largest eigenvalue, by Lanczos with full reorthogonalisation from a fixed start. Ends when the
/// residual of the Ritz pair says that an eigenvalue is within kEigenvalueError, or after 300
/// steps.
double LargestEigenvalue(const LinearMap& map, Eigen::Index n);

/// The ends of the spectrum of a symmetric matrix.
struct Spectrum {
  double smallest = 0, largest = 0;
  double condition() const { return largest / smallest; }
};

/// Both to about kEigenvalueError, the smallest as the inverse of the largest of the inverse
/// (EnvelopeCholesky); 0 if the matrix is not positive definite to working precision.
/// @param matrix  symmetric, both triangles stored.
Spectrum ExtremeEigenvalues(const Eigen::SparseMatrix<double>& matrix);

/// The s for which A + s diag(A) has a condition number, and which number that is in fact.
struct Compliance {
  double share = 0;  ///< s
  double condition = 0;
};

/// Finds that s, to 1e-3 of the condition number, by secants and bisection of log s: the number
/// falls as s grows. If the target is out of reach within 1e-12 <= s <= 1e3, the answer is the end
/// of that range, and `condition` shows it.
/// @param matrix  A, symmetric positive semidefinite, both triangles stored, diagonal > 0.
Compliance FindCompliance(const Eigen::SparseMatrix<double>& matrix, double target);

}  // namespace cairn::bench
