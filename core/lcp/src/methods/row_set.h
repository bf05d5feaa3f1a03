// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "cairn/lcp/problem.h"

namespace cairn::lcp {

/// Where a row of a problem in matrix form is: at a bound, or free between them.
enum class Side : signed char { kLower, kFree, kUpper };
using RowSet = std::vector<Side>;

/// The side of a row by the distance of x_i to its bounds: the paper's prediction.
RowSet SetByDistance(const BoxedLcp& problem, const Eigen::VectorXd& x, double tolerance);

/// The side of a row by x_i - w_i / d_i, the point to which a sweep would move it: it tells a row
/// that leaves its bound, too.
RowSet SetByNaturalMap(const BoxedLcp& problem, const Eigen::VectorXd& x, const Eigen::VectorXd& w,
                       double tolerance);

/// Brings x inside the box.
void Clamp(const BoxedLcp& problem, Eigen::VectorXd* x);

}  // namespace cairn::lcp
