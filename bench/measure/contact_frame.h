// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "cairn/contact_problem.h"

namespace cairn::bench {

/// A ContactProblem that owns its bodies and rows, and impulses to go with it.
struct ContactFrame {
  std::vector<Body> bodies;
  std::vector<Row> rows;
  std::vector<double> impulses;  ///< One per row [N s].

  ContactProblem problem() const { return {.bodies = bodies, .rows = rows}; }
};

}  // namespace cairn::bench
