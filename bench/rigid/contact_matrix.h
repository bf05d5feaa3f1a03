// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCore>

#include "cairn/contact_problem.h"
#include "cairn/mixed_lcp.h"

namespace cairn::bench {

/// J_i M^-1 J_i' of every row [1/kg], compliance left out.
Eigen::VectorXd ContactDiagonal(const ContactProblem& problem);

/// A ContactProblem in matrix form: M = J M^-1 J' + E, q = J (v_start + M^-1 impulse) - target, and
/// the bounds of the rows. Both triangles are stored and equal to the bit. An entry is stored for
/// every two rows that share a body which can move, even where it is 0, and on the diagonal.
///
/// @pre no row has a parent: friction has to be given bounds of its own (ApplyModel()).
BoxedLcp ToBoxed(const ContactProblem& problem);

}  // namespace cairn::bench
