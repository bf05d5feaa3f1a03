// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <vector>

#include "accuracy/tension/tension.h"
#include "run/scene_choice.h"

namespace cairn::accuracy {

/// One scene, displaced by seeds 0 to seeds - 1, each under the same solver.
struct StandOptions {
  cli::SceneChoice scene;
  int first = 0, seeds = 20, jobs = 1;
  double seconds = 10;              ///< At 60 Hz.
  std::optional<double> slop, erp;  ///< m_linearSlop [m] and m_erp2 [1], if not Bullet's own.
  /// Called with the number of runs that are done, by one thread at a time.
  std::function<void(int)> progress;
};

/// What became of a scene under one seed.
struct StandRun {
  std::uint64_t seed = 0;
  /// The first second at whose end it had fallen, or a body was faster than 1000 m/s.
  std::optional<int> fell = {};
  double lost = 0;   ///< Largest height lost at the end of a second, until it fell [m].
  double speed = 0;  ///< Largest at the end of the run, or when it fell [m/s].
  double gap = 0;    ///< Largest joint gap at the end of a second [m]; NaN without joints.
  double sway = 0;   ///< Furthest a body is to the side of where it began, as lost [m].
  double gain = 0;   ///< Most energy above that at the start, over that [1], of all steps.
};

/// By seed; the same for any number of jobs.
std::vector<StandRun> RunStand(const StandOptions& options, const TensionSolver& solver);

struct StandResult {
  TensionSolver solver;
  std::vector<StandRun> runs;
};

void PrintStand(const std::vector<StandResult>& results, const StandOptions& options);
nlohmann::ordered_json ToJson(const std::vector<StandResult>& results, const StandOptions& options);

}  // namespace cairn::accuracy
