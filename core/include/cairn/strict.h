// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <string>
#include <vector>

#include "cairn/contact_problem.h"

namespace cairn {

/// Something in a problem that is wrong, or that nobody can have meant.
struct Finding {
  std::string array;  ///< Of ContactProblem, "points" say; "impulses.points" and the like.
  int index = -1;     ///< In it; -1: of the array itself.
  std::string field;  ///< "normal", say; empty: the entry itself.
  std::string value;  ///< What it is, "(0, 2, 0)".
  std::string rule;   ///< What it must be, "a unit vector".
};

/// "points[3].normal is (0, 2, 0), must be a unit vector".
std::string Describe(const Finding& finding);

/// For development builds: reads the bodies, rows, joints and manifolds of a problem, and finds
/// what Solve() refuses there and what it takes silently: normals and tangents that are no unit
/// vectors, tangents along normals, rows that are all zero, rows that turn or push against what
/// Joint::angular says, a linear_b that contradicts Joint::opposite, bounds and compliances that
/// are set and not read, names of bodies that occur twice, points and rows that two manifolds or
/// joints share, contacts of two bodies that cannot move. Allocates.
/// @param most  findings after which it stops, > 0
[[nodiscard]] std::vector<Finding> ValidateStrictly(const ContactProblem& problem,
                                                    const Impulses& impulses, int most = 20);

}  // namespace cairn
