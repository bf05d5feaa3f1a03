// SPDX-License-Identifier: MIT
// For those who have Eigen: vectors and matrices of the interface as those of Eigen, in the same
// memory. Nothing of Cairn includes this for you.
#pragma once
#include "cairn/detail/cpp20.h"

#include <Eigen/Core>

#include "cairn/vector.h"

namespace cairn {

inline Eigen::Map<const Eigen::Vector3d> View(const Vector3& v) {
  return Eigen::Map<const Eigen::Vector3d>(v.data());
}
inline Eigen::Map<Eigen::Vector3d> View(Vector3& v) {
  return Eigen::Map<Eigen::Vector3d>(v.data());
}

inline Eigen::Map<const Eigen::Matrix3d> View(const Matrix3& m) {
  return Eigen::Map<const Eigen::Matrix3d>(m.data());
}
inline Eigen::Map<Eigen::Matrix3d> View(Matrix3& m) {
  return Eigen::Map<Eigen::Matrix3d>(m.data());
}

}  // namespace cairn
