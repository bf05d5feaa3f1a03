// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "cairn/contact_problem.h"

namespace cairn::cli {

/// What ten plain sweeps of one problem take, set-up included, with its pairs known from the solve
/// before.
struct Scaling {
  struct Timing {
    std::string name;
    double time = 0;  ///< [ms], median, wall clock.
  };
  int rows = 0;
  std::vector<Timing> threads;  ///< "1", "2", "4" ... with the best instruction set.
  std::vector<Timing> targets;  ///< "scalar", "sse4" ... on one thread.
};

/// Solves from zero impulses, all in turn: on 1, 2, 4 ... threads up to the cores there are,
/// and with every instruction set that runs here.
Scaling MeasureScaling(const ContactProblem& problem);

}  // namespace cairn::cli
