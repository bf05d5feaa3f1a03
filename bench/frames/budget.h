// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cairn/settings.h"
#include "frames/scene_run.h"

namespace cairn::frames {

struct BudgetOptions {
  std::vector<SceneChoice> scenes;
  std::vector<double> budgets_ms;
  int first = 30, last = 70;         ///< frames of a scene
  std::int64_t most_rows = 2000000;  ///< of all its frames: those after are left out
  int solves = 2000;                 ///< for each budget
  int min_sweeps = 1;
  int threads = 1;
  Method method = Method::kPgs;
};

/// How well Budget::Time is kept, and what is achieved in it.
void PrintBudgets(const BudgetOptions& options, const std::string& command);

}  // namespace cairn::frames
