// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cairn/settings.h"
#include "frames/scene_run.h"

namespace cairn::frames {

/// What budgets are measured with.
enum class BudgetClock {
  kWall,
  kThreadCpu,  ///< As on a machine with nothing else to do.
};

struct DeadlineOptions {
  std::vector<SceneChoice> scenes;
  int worlds = 200;  ///< Random worlds of seeds from first_seed on, all in one row.
  std::uint64_t first_seed = 0;
  std::vector<double> budgets_ms = {0.25, 0.5, 1, 2, 4, 8, 16};
  int warm_up = 30;    ///< Frames of each world that do not count.
  int frames = 240;    ///< Of a scene, after those.
  double seconds = 3;  ///< Of a random world, with those.
  BudgetClock clock = BudgetClock::kWall;
  Settings settings;  ///< All but the budget and its clock.
};

/// By how much the adapter exceeds Budget::Time in worlds that it drives, CPU time and wall clock.
void PrintDeadlines(const DeadlineOptions& options, const std::string& command);

}  // namespace cairn::frames
