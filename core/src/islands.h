// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "cairn/contact_problem.h"

namespace cairn {

/// Bodies connected by rows, and those rows in the order of the problem. Bodies that cannot move
/// connect nothing and belong to no island.
struct Island {
  std::vector<int> bodies;  ///< ascending problem indices
  std::vector<int> rows;    ///< ascending problem indices
};

bool CanMove(const Body& body);

/// Ordered by their first body. Rows without a movable body form a last island without bodies.
std::vector<Island> FindIslands(const ContactProblem& problem);

}  // namespace cairn
