// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "contestants/solver_registry.h"
#include "run/scene_choice.h"
#include "support/machine/setup.h"
#include "support/progress.h"

namespace cairn::cli {

/// What `cairn run` was asked for, checked.
struct RunOptions {
  std::vector<SceneChoice> scenes;
  std::vector<SolverChoice> solvers;
  std::optional<std::chrono::nanoseconds> budget;
  std::optional<std::int64_t> units;  ///< Work for a frame, instead of a budget of time.
  IterationRule iterations;
  int frames = 300;
  int warmup = 0;  ///< The first frames, which are run but do not count.
  int repeat = 1;  ///< Times that everything is run.
  Setup setup;
  std::uint64_t seed = 0;
  int samples = 8;
  ProgressMode progress = ProgressMode::kAuto;
  bool noise = false;  ///< Shows how noisy the machine was.
  /// Records what only the page shows: facts of each frame, motion, and error against time.
  bool page = false;
  /// Records what threads do in each frame, and keeps the slowest frame, or this one.
  bool timelines = false;
  std::optional<int> trace_frame;
};

}  // namespace cairn::cli
