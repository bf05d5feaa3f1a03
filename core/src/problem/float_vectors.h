// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace cairn {

/// Vectors of rows and points, which are floats or doubles, as one kind.
inline Eigen::Vector3d ToVector(const float* from) { return {from[0], from[1], from[2]}; }
inline Eigen::Vector3d ToVector(const Eigen::Vector3d& from) { return from; }

inline void Put(const Eigen::Vector3d& from, float* to) {
  for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(from[k]);
}

}  // namespace cairn
