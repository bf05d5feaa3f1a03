// SPDX-License-Identifier: MIT
#pragma once

#include "cairn/contact_problem.h"

namespace cairn {

/// What of the target of a row of a joint takes back an error of position [m/s] or [rad/s]; see
/// ContactProblem::joint_errors.
inline float ErrorOf(const ContactProblem& problem, const Joint& joint, int row) {
  const int at = joint.first_row + row;
  if (!problem.joint_errors.empty()) return problem.joint_errors[at];
  return (joint.errors >> row & 1) != 0 ? problem.joint_rows[at].target : 0;
}

}  // namespace cairn
