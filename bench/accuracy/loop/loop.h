// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <chrono>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "accuracy/shadow.h"
#include "run/scene_choice.h"

namespace cairn::accuracy {

struct LoopOptions {
  std::vector<cli::SceneChoice> scenes;  ///< Their seeds are not used.
  int frames = 300;
  int seeds = 20;  ///< Runs, from seed 1 on: bodies start displaced by up to 0.1 mm.
  std::vector<std::chrono::nanoseconds> budgets;
};

/// The figures of a run, means over the second half of its frames; NaN where one does not apply,
/// infinity from a failed run.
struct LoopFigures {
  double height_lost = 0;             ///< [m]
  double joint_gap = 0;               ///< [m]
  double penetration = 0;             ///< [m]
  double residual = 0;                ///< [m/s], largest of all rows.
  double largest_rest = 0;            ///< Largest speed of a body at rest [m/s].
  double time = 0;                    ///< In the solver [ms].
  double accepted = 0, restored = 0;  ///< Subspace steps per frame.
};
struct LoopFigure {
  const char *name, *unit, *key;
  double LoopFigures::*value;
  double scale;  ///< From the unit of LoopFigures to `unit`.
};
inline constexpr std::array kLoopFigures = {
    LoopFigure{"height lost", "mm", "height_lost_m", &LoopFigures::height_lost, 1e3},
    LoopFigure{"joint gap", "mm", "joint_gap_m", &LoopFigures::joint_gap, 1e3},
    LoopFigure{"penetration", "mm", "penetration_m", &LoopFigures::penetration, 1e3},
    LoopFigure{"residual", "m/s", "residual_m_s", &LoopFigures::residual, 1},
    LoopFigure{"speed", "m/s", "speed_at_rest_m_s", &LoopFigures::largest_rest, 1},
    LoopFigure{"time", "ms", "time_ms", &LoopFigures::time, 1},
    LoopFigure{"accepted", "/frame", "steps_accepted", &LoopFigures::accepted, 1},
    LoopFigure{"restored", "/frame", "steps_restored", &LoopFigures::restored, 1}};

/// One solver on one scene, all seeds.
struct LoopSolver {
  std::string name, effort;
  std::vector<LoopFigures> runs;  ///< One per seed, from seed 1 on.
  int collapsed = 0;              ///< Runs in which it fell, or in which the solver failed.
  std::vector<std::string> failures;
  bool can_fall = false;  ///< There is something in the scene that should stand.
};

struct LoopScene {
  cli::SceneChoice scene;
  /// For each budget Cairn as each of kKinds, in this order; last Bullet.
  std::vector<LoopSolver> solvers;

  const LoopSolver& Of(size_t budget, Kind kind) const {
    return solvers[budget * kKinds.size() + static_cast<size_t>(kind)];
  }
  const LoopSolver& bullet() const { return solvers.back(); }
  int seeds() const { return static_cast<int>(solvers.back().runs.size()); }  ///< Done.
};

/// Every scene with the first seed, then with the second: what is done when it is stopped can be
/// compared. Scenes without a run are left out.
/// @param show  is told what is being done
/// @param stop  is asked after each scene and seed whether that was enough
std::vector<LoopScene> RunLoops(const LoopOptions& options,
                                const std::function<void(const std::string&)>& show,
                                const std::function<bool()>& stop);

/// How to read it, and a table for each scene; loop_tables.py has the statistics.
void PrintLoop(std::span<const LoopScene> scenes, const LoopOptions& options);

nlohmann::ordered_json ToJson(std::span<const LoopScene> scenes, const LoopOptions& options);

}  // namespace cairn::accuracy
