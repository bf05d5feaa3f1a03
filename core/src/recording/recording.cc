// SPDX-License-Identifier: MIT
#include "cairn/detail/recording.h"

#include "problem/contact_expansion.h"
#include "problem/validate.h"

namespace cairn {

void Recording::Assign(const ContactProblem& problem, const Impulses& start) {
  bodies.assign(problem.bodies.begin(), problem.bodies.end());
  rows.assign(problem.rows.begin(), problem.rows.end());
  manifolds.assign(problem.manifolds.begin(), problem.manifolds.end());
  points.assign(problem.points.begin(), problem.points.end());
  contact_law = problem.contact_law;
  motions.assign(problem.motions.begin(), problem.motions.end());
  row_impulses.assign(start.rows.begin(), start.rows.end());
  point_impulses.assign(start.points.begin(), start.points.end());
  twists.assign(problem.twists.begin(), problem.twists.end());
  twist_impulses.assign(start.twists.begin(), start.twists.end());
  joints.assign(problem.joints.begin(), problem.joints.end());
  joint_rows.assign(problem.joint_rows.begin(), problem.joint_rows.end());
  joint_errors.assign(problem.joint_errors.begin(), problem.joint_errors.end());
  joint_impulses.assign(start.joint_rows.begin(), start.joint_rows.end());
  time_step = problem.time_step;
}

Status WriteOutRows(const Recording& recording, Recording* rows) {
  Recording copy = recording;
  const Impulses start = copy.impulses();
  const ContactProblem problem = copy.problem();
  if (const Report checked = Validate(problem, start); !checked.ok()) return checked.status;
  if (!copy.manifolds.empty() || !copy.joints.empty()) {
    ContactExpansion expansion(problem, start);
    const std::vector<Row> all(expansion.problem().rows.begin(), expansion.problem().rows.end());
    const std::vector<double> impulses(expansion.impulses().begin(), expansion.impulses().end());
    copy.rows = all;
    copy.row_impulses = impulses;
    copy.manifolds.clear();
    copy.points.clear();
    copy.point_impulses.clear();
    copy.twists.clear();
    copy.twist_impulses.clear();
    copy.motions.clear();
    copy.joints.clear();
    copy.joint_rows.clear();
    copy.joint_errors.clear();
    copy.joint_impulses.clear();
  }
  *rows = std::move(copy);
  return Status::kOk;
}

}  // namespace cairn
