// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace cairn {

/// The three linear parts are unit vectors at right angles to each other.
inline bool AreAxes(const Eigen::Matrix3d& linear) {
  constexpr double kUnit = 1e-3;  // how far they may be from that, squared
  return (linear.transpose() * linear - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < kUnit;
}

/// The arm r of three rows l_i . v + (r x l_i) . omega.
inline Eigen::Vector3d ArmOf(const Eigen::Matrix3d& linear, const Eigen::Matrix3d& angular) {
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) arm += 0.5 * linear.col(i).cross(angular.col(i));
  return arm;
}

}  // namespace cairn
