// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <span>

#include "cairn/contact_problem.h"

namespace cairn {

/// Whether vector(0) to vector(2) are unit vectors at right angles to each other.
template <class Vectors>
bool AreAxes(const Vectors& vector) {
  constexpr double kFar = 1e-3;  // how far their products may be from 1 and 0
  double axes[3][3];
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) axes[i][k] = static_cast<double>(vector(i)[k]);
    for (int j = 0; j <= i; ++j) {
      double product = i == j ? -1 : 0;
      for (int k = 0; k < 3; ++k) product += axes[i][k] * axes[j][k];
      if (!(std::abs(product) < kFar)) return false;
    }
  }
  return true;
}

/// Pulls and pushes alike: has no bounds, or those of what may break and of motors.
inline bool IsTwoSided(double lo, double hi) { return lo == -hi; }

inline bool IsTwoSided(const Joint& joint, const JointRow* rows, int row) {
  return !joint.is_bounded(row) || IsTwoSided(rows[row].lo, rows[row].hi);
}

/// The linear parts of three rows that pull at a point are the axes of the world, in order, as
/// those of pins and hinges are.
inline bool AreWorldAxes(const Joint& joint, const JointRow* rows, int first) {
  if (!joint.opposite) return false;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      if (rows[first + i].linear_a[k] != (i == k ? 1 : 0)) return false;
    }
  }
  return true;
}

/// So many rows that follow each other have linear parts, and pull and push alike.
/// @param rows  of the joint; @param first  the first of them
inline bool PullAlike(const Joint& joint, const JointRow* rows, int first, int count) {
  if ((joint.angular >> first & ((1u << count) - 1)) != 0) return false;
  for (int row = first; row < first + count; ++row) {
    if (!IsTwoSided(joint, rows, row)) return false;
  }
  return true;
}

/// The linear parts of three rows are unit vectors at right angles to each other.
inline bool ThreeAreAxes(const Joint& joint, const JointRow* rows, int first) {
  const bool of_a = joint.body_a != kWorld || joint.opposite;
  return AreAxes([&](int i) -> const float(&)[3] {
    return of_a ? rows[first + i].linear_a : rows[first + i].linear_b;
  });
}

/// Three rows that follow each other pull at a point: they pull and push alike, and their linear
/// parts are axes.
inline bool PullAtPoint(const Joint& joint, const JointRow* rows, int first) {
  return PullAlike(joint, rows, first, 3) &&
         (AreWorldAxes(joint, rows, first) || ThreeAreAxes(joint, rows, first));
}

/// The same for two rows, where bodies cannot move across them: a row that moves nobody is left
/// out, as in games in a plane.
inline bool PullInPlane(const Joint& joint, const JointRow* rows, int first,
                        std::span<const Body> bodies) {
  constexpr double kLocked = 1e-3;  // share of an axis that is left
  if (!PullAlike(joint, rows, first, 2)) return false;
  const bool of_a = joint.body_a != kWorld || joint.opposite;
  const auto vector = [&](int i) {
    const float(&l)[3] = of_a ? rows[first + i].linear_a : rows[first + i].linear_b;
    return Eigen::Vector3d(l[0], l[1], l[2]);
  };
  const Eigen::Vector3d axes[] = {vector(0), vector(1), vector(0).cross(vector(1))};
  const auto locked = [&](int body) {
    if (body == kWorld || bodies[body].inv_mass <= 0) return true;
    const Eigen::Vector3d factor(bodies[body].linear_factor);
    return factor.cwiseProduct(axes[2]).norm() < kLocked;
  };
  return AreAxes([&](int i) { return axes[i]; }) && locked(joint.body_a) && locked(joint.body_b);
}

/// Three rows that pull at a point and have no bounds, so that they hold it.
inline bool HoldPoint(const Joint& joint, const JointRow* rows, int first) {
  return (joint.bounded >> first & 7) == 0 && PullAtPoint(joint, rows, first);
}

/// Three rows of a joint that follow each other, as columns, or two and a third of zeros.
struct RowTriple {
  Eigen::Matrix3d linear_a, angular_a, linear_b, angular_b;
};

/// @param rows  of the joint; @param first  the first of them
inline RowTriple ReadTriple(const Joint& joint, const JointRow* rows, int first, int count = 3) {
  const auto vector = [](const float(&from)[3]) {
    return Eigen::Vector3d(from[0], from[1], from[2]);
  };
  RowTriple triple;
  for (Eigen::Matrix3d* of :
       {&triple.linear_a, &triple.angular_a, &triple.linear_b, &triple.angular_b}) {
    of->setZero();
  }
  for (int k = 0; k < count; ++k) {
    const JointRow& row = rows[first + k];
    triple.linear_a.col(k) = vector(row.linear_a);
    triple.angular_a.col(k) = vector(row.angular_a);
    triple.linear_b.col(k) = joint.opposite ? vector(row.linear_a) * -1 : vector(row.linear_b);
    triple.angular_b.col(k) = vector(row.angular_b);
  }
  return triple;
}

/// ArmOf() of three rows along the axes of the world, whose angular parts those are.
inline Eigen::Vector3d ArmOfWorldAxes(const float (&x)[3], const float (&y)[3],
                                      const float (&z)[3]) {
  return 0.5 * Eigen::Vector3d(static_cast<double>(y[2]) - static_cast<double>(z[1]),
                               static_cast<double>(z[0]) - static_cast<double>(x[2]),
                               static_cast<double>(x[1]) - static_cast<double>(y[0]));
}

/// The part in their plane of the arm of two such rows.
inline Eigen::Vector3d ArmInPlane(const Eigen::Matrix3d& linear, const Eigen::Matrix3d& angular) {
  const Eigen::Vector3d across = linear.col(0).cross(linear.col(1));
  return angular.col(1).dot(across) * linear.col(0) - angular.col(0).dot(across) * linear.col(1);
}

/// The arm r of three rows l_i . v + (r x l_i) . omega.
inline Eigen::Vector3d ArmOf(const Eigen::Matrix3d& linear, const Eigen::Matrix3d& angular) {
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) arm += 0.5 * linear.col(i).cross(angular.col(i));
  return arm;
}

}  // namespace cairn
