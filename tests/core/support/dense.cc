// SPDX-License-Identifier: MIT
#include "dense.h"
#include "cairn/detail/eigen.h"

#include <algorithm>
#include <cmath>

namespace cairn::test {

Dense MakeDense(const Scene& scene) {
  const int n = static_cast<int>(scene.rows.size()), m = static_cast<int>(scene.bodies.size());
  Dense dense;
  dense.inverse_mass = Eigen::MatrixXd::Zero(6 * m, 6 * m);
  Eigen::VectorXd start(6 * m), impulse(6 * m);
  for (int i = 0; i < m; ++i) {
    const Body& body = scene.bodies[i];
    for (int k = 0; k < 3; ++k) {
      dense.inverse_mass(6 * i + k, 6 * i + k) = body.inv_mass * body.linear_factor[k];
    }
    dense.inverse_mass.block<3, 3>(6 * i + 3, 6 * i + 3) = View(body.inv_inertia);
    start.segment<6>(6 * i) << View(body.velocity.linear), View(body.velocity.angular);
    impulse.segment<6>(6 * i) << View(body.impulse), View(body.angular_impulse);
  }

  dense.J = Eigen::MatrixXd::Zero(n, 6 * m);
  Eigen::VectorXd target(n), compliance(n);
  for (int i = 0; i < n; ++i) {
    const Row& row = scene.rows[i];
    if (row.body_a >= 0) {
      dense.J.row(i).segment<6>(6 * row.body_a) << View(row.linear_a).transpose(),
          View(row.angular_a).transpose();
    }
    if (row.body_b >= 0) {
      dense.J.row(i).segment<6>(6 * row.body_b) << View(row.linear_b).transpose(),
          View(row.angular_b).transpose();
    }
    target[i] = row.target;
    compliance[i] = row.compliance;
  }

  dense.free = start + dense.inverse_mass * impulse;
  dense.A = dense.J * dense.inverse_mass * dense.J.transpose();
  dense.A += compliance.asDiagonal();
  dense.b = target - dense.J * dense.free;
  return dense;
}

Eigen::VectorXd Flatten(const std::vector<Velocity>& velocities) {
  Eigen::VectorXd flat(6 * velocities.size());
  for (size_t i = 0; i < velocities.size(); ++i) {
    flat.segment<6>(6 * i) << View(velocities[i].linear), View(velocities[i].angular);
  }
  return flat;
}

Eigen::VectorXd ToVector(std::span<const double> x) {
  return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
}

double Project(const Scene& scene, const Eigen::VectorXd& x, int i, double value) {
  const Row& row = scene.rows[i];
  double lo = row.lo, hi = row.hi;
  if (row.parent != kNoRow) {
    const double most = row.friction * std::max(0.0, x[row.parent]);
    lo = std::max(lo, -most);
    hi = std::min(hi, most);
  }
  return std::min(std::max(value, lo), hi);
}

void DenseSweep(const Scene& scene, const Dense& dense, Eigen::VectorXd* x) {
  for (int i = 0; i < x->size(); ++i) {
    const double w = dense.A.row(i).dot(*x) - dense.b[i];
    const double step = scene.rows[i].relaxation * w / dense.A(i, i);
    (*x)[i] = Project(scene, *x, i, (*x)[i] - step);
  }
}

Residual DenseResidual(const Scene& scene, const Dense& dense, const Eigen::VectorXd& x) {
  const Eigen::VectorXd w = dense.A * x - dense.b;
  Residual residual;
  double squares = 0;
  for (int i = 0; i < x.size(); ++i) {
    const double d = dense.A(i, i);
    const double error = d * std::abs(x[i] - Project(scene, x, i, x[i] - w[i] / d));
    const Row& row = scene.rows[i];
    const bool turns_only = View(row.linear_a).norm() + View(row.linear_b).norm() == 0;
    double& largest = turns_only ? residual.max_angular : residual.max;
    largest = std::max(largest, error);
    squares += error * error / d;
  }
  residual.energy = std::sqrt(squares);
  return residual;
}

}  // namespace cairn::test
