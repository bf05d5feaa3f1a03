// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "cairn/contact_problem.h"

namespace cairn {

/// Judges a whole input and names what is wrong with it. The path in double precision relies on
/// what is checked here. Blocks judge numbers as they are filled (plan/row_kind, pack/): what they
/// refuse comes here. On a status other than kOk, bad_row, bad_body, bad_manifold or bad_joint of
/// the report names the first offender.
Report Validate(const ContactProblem& problem, const Impulses& impulses);

/// The first span that does not belong to the problem: "impulses.rows.size() is 3, must be
/// problem.rows.size()". No name: all do.
BadSetting FindBadSize(const ContactProblem& problem, const Impulses& impulses);

/// What a manifold says of itself; not its points.
Status ValidateManifold(const ContactProblem& problem, int manifold);

/// What a joint says of itself; not its rows.
Status ValidateJoint(const ContactProblem& problem, int joint);

/// One row of it. @pre the bodies are valid
Status ValidateRow(const ContactProblem& problem, int row, double impulse);

/// R with R R' = inv_inertia, zero columns last where the matrix has no rank. False if the matrix
/// is not symmetric positive semidefinite, to the precision of a float.
bool FactorInertia(const Eigen::Matrix3d& inv_inertia, Eigen::Matrix3d* factor);

}  // namespace cairn
