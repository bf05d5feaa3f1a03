// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "accuracy/bullet_trial.h"
#include "accuracy/shadow.h"
#include "measure/converged.h"
#include "measure/velocity_norm.h"
#include "run/scene_choice.h"

namespace cairn::accuracy {

struct StatesOptions {
  std::vector<cli::SceneChoice> scenes;
  int frames = 240;
  int samples = 12;     ///< Of these frames, one in four at most.
  int iterations = 10;  ///< Of Bullet, on each state.
  int advance = 200;    ///< Iterations of Bullet that make the states.
  int rounds = 7;       ///< Of Bullet on each state that is sampled, to time it.
  int most = 5000;      ///< Iterations of Bullet that are followed.
  int reference =
      static_cast<int>(bench::kReferenceWork / 1e6);  ///< Millions of relaxations of rows.
};

/// What Cairn made of a state.
struct CairnResult {
  bench::VelocityDistance error;
  ShadowFrame frame;
  std::optional<int> worth;  ///< Iterations of Bullet until its rms is no larger, if it got there.
};

/// One state and what everyone made of it.
struct StateResult {
  int frame = 0, bodies = 0, rows = 0;
  BulletTime bullet_time;                ///< Medians; the total is the budget.
  bench::VelocityDistance bullet_error;  ///< After StatesOptions::iterations.
  bench::VelocityDistance start_error;   ///< Of the warm start, before any iteration.
  int followed = 0;                      ///< Iterations of Bullet that were looked at,
  bench::VelocityDistance last_error;    ///< and its error after them.
  bench::Converged reference;            ///< Less its velocities.
  std::array<CairnResult, kKinds.size()> cairn;

  const CairnResult& Of(Kind kind) const { return cairn[static_cast<size_t>(kind)]; }
  /// Smallest rms of anyone.
  double LeastError() const;
  /// Steps are worse than the other kind by more than a twentieth and what solutions differ.
  bool StepsAreWorseThan(Kind other) const;
  /// A solve of Cairn's was taken off its core, whose wall clock went on.
  bool Interrupted() const;
};

struct SceneStates {
  cli::SceneChoice scene;
  std::vector<StateResult> states;
  int empty = 0;  ///< Samples in which nothing touched.
  /// Frames in which something touched, Cairn with steps, less the first few, in which memory is
  /// allocated and prices are learnt.
  std::vector<ShadowFrame> frames;
};

/// @param show  is told what is being done
SceneStates MeasureStates(const cli::SceneChoice& scene, const StatesOptions& options,
                          const std::function<void(const std::string&)>& show);

struct Tail {
  double p50 = 0, p99 = 0, max = 0;
};

/// What a shadow did over many frames; NaN where it never did it.
struct FrameStatistics {
  int frames = 0;
  double stepped = 0;         ///< Share of frames with a step, kept or not.
  double restored = 0;        ///< Share of steps that were undone.
  double factorisations = 0;  ///< Mean.
  Tail cpu_over, wall_over;   ///< Time above the budget; negative: inside it [us].
  Tail wall_over_calm;        ///< The same, of frames that were not interrupted [us].
  int interrupted = 0;
  Tail step_error;  ///< |time / prediction - 1| of steps, of frames that were not interrupted.
};

FrameStatistics StatisticsOf(std::span<const ShadowFrame> frames);

/// What the velocity error with steps may be at most, as a share of that of Bullet's 10 iterations
/// in the same time. NaN for a scene without a goal.
double GoalOf(std::string_view scene);

/// How to read it, and tables of errors, work, frames and of what was compared.
void PrintStates(std::span<const SceneStates> scenes, const StatesOptions& options);

nlohmann::ordered_json ToJson(std::span<const SceneStates> scenes, const StatesOptions& options);

}  // namespace cairn::accuracy
