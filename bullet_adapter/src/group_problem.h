// SPDX-License-Identifier: MIT
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btManifoldPoint.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <vector>

#include "cairn/bullet/precision.h"
#include "cairn/contact_problem.h"
#include "contacts/friction_directions.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// The rows of a joint, in the order in which it gave them.
struct JointRows {
  btTypedConstraint* joint = nullptr;
  bool written_out = false;     ///< Into GroupProblem::rows; otherwise into joint_rows.
  int first_row = 0, rows = 0;  ///< There.
  bool a_moves = false, b_moves = false;
};

/// The rows of a contact point. Those of friction follow each other.
struct PointRows {
  btManifoldPoint* point;
  int normal_row, friction_row, twist_row;
  int frictions, twists;
  LeftDirections left;
};

/// The rows of a group with their start, and whose they are. Of those that are written out joints
/// come first, then manifold by manifold the normals of its points, their friction, and what
/// resists rolling.
struct GroupProblem {
  std::vector<Row> rows;
  std::vector<double> impulses;  ///< One per row: the start, and after solving the result [N s].
  std::vector<Joint> compact_joints;  ///< Those that are not written out.
  std::vector<JointRow> joint_rows;
  std::vector<float> joint_errors;    ///< See ContactProblem.
  std::vector<float> joint_impulses;  ///< One per joint_rows, likewise.
  std::vector<JointRows> joints;
  std::vector<PointRows> points;

  void Clear() {
    rows.clear();
    impulses.clear();
    compact_joints.clear();
    joint_rows.clear();
    joint_errors.clear();
    joint_impulses.clear();
    joints.clear();
    points.clear();
  }

  /// Impulse of a row of a joint.
  double impulse(const JointRows& joint, int row) const {
    const int at = joint.first_row + row;
    return joint.written_out ? impulses[at] : static_cast<double>(joint_impulses[at]);
  }

  /// Appends a row that begins as a copy of @p first. The reference is good until the next one.
  Row& Append(const Row& first, double impulse) {
    impulses.push_back(impulse);
    rows.push_back(first);
    return rows.back();
  }
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
