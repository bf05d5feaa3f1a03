// SPDX-License-Identifier: MIT
#pragma once

#include "cairn/detail/cpp20.h"

#include <Eigen/SparseCore>

#include "cairn/boxed_lcp.h"
#include "cairn/report.h"

namespace cairn {

/// The mixed linear complementarity problem in the letters of [1] (boxed_lcp.h): find u and v with
///   A u + C v + a = 0,   C' u + B v + b >= 0,   v >= 0,   v' (C' u + B v + b) = 0.
/// In a time step u are the impulses of joints, v those of contacts.
struct MixedLcp {
  /// n_a x n_a and n_b x n_b, both triangles stored, and n_a x n_b; [A C; C' B] symmetric positive
  /// definite. n_a or n_b may be 0.
  Eigen::SparseMatrix<double> A, B, C;
  Eigen::VectorXd a, b;  ///< n_a and n_b.
};

/// The same problem with x = (u, v) and bounds -inf <= u, 0 <= v.
/// @pre Validate(problem) is ok.
[[nodiscard]] BoxedLcp ToBoxed(const MixedLcp& problem);

/// Sizes only (Status::kWrongSize): the rest is judged in the boxed form, whose row n_a + i is row
/// i of v.
Report Validate(const MixedLcp& problem);

}  // namespace cairn
