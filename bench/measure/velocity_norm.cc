// SPDX-License-Identifier: MIT
#include "measure/velocity_norm.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "cairn/detail/eigen.h"
#include "measure/reference.h"

namespace cairn::bench {
namespace {

double Inverse(double value) { return value > 0 ? 1 / value : 0; }

/// Inverse in the directions in which the body turns at all.
Eigen::Matrix3d Inertia(const Eigen::Matrix3d& inv_inertia) {
  constexpr double kRounding = 1e-9;  // relative: matrices come from floats
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(inv_inertia);
  const double least = kRounding * eigen.eigenvalues().cwiseAbs().maxCoeff();
  const Eigen::Vector3d inverse =
      eigen.eigenvalues().unaryExpr([least](double e) { return e > least ? 1 / e : 0.0; });
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace

VelocityNorm::VelocityNorm(std::span<const Body> bodies) {
  for (const Body& body : bodies) {
    Mass& mass = masses_.emplace_back();
    mass.linear = (body.inv_mass * View(body.linear_factor)).unaryExpr(&Inverse);
    mass.angular = Inertia(body.inv_inertia);
    total_mass_ += Inverse(body.inv_mass);
  }
}

VelocityDistance VelocityNorm::Between(std::span<const Velocity> a,
                                       std::span<const Velocity> b) const {
  double energy = 0;  // twice it
  for (size_t i = 0; i < masses_.size(); ++i) {
    const Eigen::Vector3d v = View(a[i].linear) - View(b[i].linear),
                          w = View(a[i].angular) - View(b[i].angular);
    energy += v.dot(masses_[i].linear.cwiseProduct(v)) + w.dot(masses_[i].angular * w);
  }
  if (!std::isfinite(energy)) energy = std::numeric_limits<double>::infinity();
  return {.rms = total_mass_ > 0 ? std::sqrt(energy / total_mass_) : 0, .max = VelocityError(a, b)};
}

}  // namespace cairn::bench
