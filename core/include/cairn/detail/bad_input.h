// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <vector>

#include "cairn/contact_problem.h"

namespace cairn {

/// What Solve() refuses of a problem, each thing for itself: places, ascending. Who knows what they
/// stand for may leave them out.
struct BadInput {
  std::vector<int> bodies, rows, joints, manifolds;

  bool empty() const {
    return bodies.empty() && rows.empty() && joints.empty() && manifolds.empty();
  }
};

/// @pre the sizes of all spans fit each other
BadInput FindBadInput(const ContactProblem& problem, const Impulses& impulses);

}  // namespace cairn
