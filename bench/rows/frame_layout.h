// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "rows/row_problem.h"

namespace cairn::cli {

/// Where the bodies of a recorded frame may have been. A recording has neither positions nor
/// shapes, but the arms of contacts and joints say where bodies are beside each other, and masses
/// and moments of inertia how long and wide they are.
///
/// Bodies that hang together are beside each other as they were, up to gaps and penetration; groups
/// that do not touch the world stand in a row. Each body is a box with its mass and inertia, turned
/// as its principal axes are; where two of these are equal, as the world is. The lowest contact
/// with the world, else the lowest body, is at y = 0.
struct FrameLayout {
  struct Box {
    Eigen::Vector3d centre;  ///< [m]
    Eigen::Matrix3d axes;    ///< Columns, of length 1, right-handed.
    Eigen::Vector3d half;    ///< Half extents along them [m].
    double mass = 0;         ///< [kg], 0: no impulse moves it.
    int group = 0;           ///< The same for bodies that hang together.
  };
  /// Where rows of a joint pull, as seen from both bodies [m].
  struct Anchors {
    int body_a, body_b;  ///< One of them may be kWorld.
    Eigen::Vector3d a, b;
  };
  std::vector<Box> boxes;       ///< One per body.
  std::vector<Anchors> joints;  ///< Of those that hold points, not turns alone.
  double ground = 0;            ///< Half of the side of a ground below all of it [m].
};

FrameLayout LayOut(const RowProblem& problem);

}  // namespace cairn::cli
