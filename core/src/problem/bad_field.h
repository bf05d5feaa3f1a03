// SPDX-License-Identifier: MIT
#pragma once

#include "cairn/contact_problem.h"
#include "cairn/report.h"

namespace cairn {

/// Which field of a body, row, joint or manifold a status speaks of, with its value. No name: the
/// status says all there is to say. Slow, for what was refused.
/// @pre the ranges of joints and manifolds are inside their arrays
BadSetting FindBadFieldOfBody(const ContactProblem& problem, int body, Status status);
BadSetting FindBadFieldOfRow(const ContactProblem& problem, const Impulses& start, int row,
                             Status status);
BadSetting FindBadFieldOfJoint(const ContactProblem& problem, const Impulses& start, int joint,
                               Status status);
BadSetting FindBadFieldOfManifold(const ContactProblem& problem, const Impulses& start,
                                  int manifold, Status status);

}  // namespace cairn
