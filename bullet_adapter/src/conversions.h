// SPDX-License-Identifier: MIT
#pragma once

#include <LinearMath/btMatrix3x3.h>
#include <LinearMath/btVector3.h>

#include <Eigen/Core>

#include "cairn/bullet/precision.h"
#include "cairn/contact_problem.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// Bounds of at least this size are Bullet's way to say infinity [N s].
inline constexpr double kUnbounded = 1e10;
/// Targets beyond this stand for infinity, which 6dof springs ask for; they can only end at a
/// bound.
inline constexpr double kMostTarget = 1e12;

inline Eigen::Vector3d ToEigen(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

inline btVector3 ToBullet(const Eigen::Vector3d& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

inline btVector3 ToBullet(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

inline Eigen::Matrix3d ToEigen(const btMatrix3x3& m) {
  Eigen::Matrix3d result;
  for (int i = 0; i < 3; ++i) result.row(i) = ToEigen(m[i]).transpose();
  return result;
}

inline double Bound(btScalar value) {
  if (value >= kUnbounded) return kInfinity;
  if (value <= -kUnbounded) return -kInfinity;
  return value;
}

/// What makes no sense below 0; what is not a number stays that.
inline btScalar NotBelowZero(btScalar value) { return value < 0 ? btScalar(0) : value; }

/// Step lengths that a sweep can be made with; where Bullet's diverges, the exact one.
inline double Relaxation(double factor) { return factor > 0 && factor < 1.99 ? factor : 1.0; }

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
