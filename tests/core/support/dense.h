// SPDX-License-Identifier: MIT
// The textbook, in dense matrices and in the units of the caller: no islands, no whitening.
#pragma once

#include <Eigen/Core>
#include <span>

#include "problems.h"

namespace cairn::test {

/// w = A x - b with A = J M^-1 J' + E.
struct Dense {
  Eigen::MatrixXd J;             ///< rows x 6 bodies
  Eigen::MatrixXd inverse_mass;  ///< M^-1
  Eigen::MatrixXd A;
  Eigen::VectorXd b, free;  ///< free: velocities without constraints
};

Dense MakeDense(const Scene& scene);

/// Linear before angular, body after body.
Eigen::VectorXd Flatten(const std::vector<Velocity>& velocities);
Eigen::VectorXd ToVector(std::span<const double> x);

/// x_i cut down to the bounds of row i, those of friction from the present impulse of its parent.
double Project(const Scene& scene, const Eigen::VectorXd& x, int i, double value);

/// One sweep of projected Gauss-Seidel.
void DenseSweep(const Scene& scene, const Dense& dense, Eigen::VectorXd* x);

Residual DenseResidual(const Scene& scene, const Dense& dense, const Eigen::VectorXd& x);

}  // namespace cairn::test
