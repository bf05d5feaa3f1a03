// SPDX-License-Identifier: MIT
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btManifoldPoint.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <vector>

#include "cairn/bullet/precision.h"
#include "cairn/contact_problem.h"
#include "friction_directions.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// The rows of a joint, in the order in which it gave them.
struct JointRows {
  btTypedConstraint* joint;
  int first_row, rows;
};

/// The rows of a contact point. Those of friction follow each other.
struct PointRows {
  btManifoldPoint* point;
  int normal_row, friction_row, twist_row;
  int frictions, twists;
  LeftDirections left;
};

/// The rows of a group with their start, and whose they are. Joints come first, then manifold by
/// manifold the normals of its points, their friction, and what resists rolling.
struct GroupProblem {
  std::vector<Row> rows;
  std::vector<double> impulses;  ///< One per row: the start, and after solving the result [N s].
  std::vector<JointRows> joints;
  std::vector<PointRows> points;

  void Clear() {
    rows.clear();
    impulses.clear();
    joints.clear();
    points.clear();
  }

  /// Appends a row that begins as a copy of @p law. The reference is good until the next one.
  Row& Append(const Row& law, double impulse) {
    impulses.push_back(impulse);
    rows.push_back(law);
    return rows.back();
  }
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
