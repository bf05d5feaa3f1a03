// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>

#include "cairn/joint.h"

namespace cairn {

/// Three rows of a joint that follow each other, as columns.
struct RowTriple {
  Eigen::Matrix3d linear_a, angular_a, linear_b, angular_b;
  bool bounded = false;  ///< one of them is
};

/// @param rows  of the joint; @param first  the first of the three
inline RowTriple ReadTriple(const Joint& joint, const JointRow* rows, int first) {
  const auto vector = [](const float(&from)[3]) {
    return Eigen::Vector3d(from[0], from[1], from[2]);
  };
  RowTriple triple;
  for (int k = 0; k < 3; ++k) {
    const JointRow& row = rows[first + k];
    triple.linear_a.col(k) = vector(row.linear_a);
    triple.angular_a.col(k) = vector(row.angular_a);
    triple.linear_b.col(k) = joint.opposite ? vector(row.linear_a) * -1 : vector(row.linear_b);
    triple.angular_b.col(k) = vector(row.angular_b);
    triple.bounded = triple.bounded || joint.is_bounded(first + k);
  }
  return triple;
}

/// The three linear parts are unit vectors at right angles to each other.
inline bool AreAxes(const Eigen::Matrix3d& linear) {
  constexpr double kUnit = 1e-3;  // how far they may be from that, squared
  return (linear.transpose() * linear - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < kUnit;
}

/// Of a body that is there.
inline bool AreAxes(const RowTriple& rows, const Joint& joint) {
  return AreAxes(joint.body_a != kWorld ? rows.linear_a : rows.linear_b);
}

/// The arm r of three rows l_i . v + (r x l_i) . omega.
inline Eigen::Vector3d ArmOf(const Eigen::Matrix3d& linear, const Eigen::Matrix3d& angular) {
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) arm += 0.5 * linear.col(i).cross(angular.col(i));
  return arm;
}

}  // namespace cairn
