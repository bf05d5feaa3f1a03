// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "accuracy/bullet_trial.h"
#include "accuracy/cairn_trial.h"
#include "accuracy/converged.h"
#include "cli/scene_choice.h"

namespace cairn::accuracy {

struct StatesOptions {
  std::vector<cli::SceneChoice> scenes;
  int frames = 240;
  int samples = 6;      ///< Of these frames, one in four at most.
  int iterations = 10;  ///< Of Bullet, on each state.
  int advance = 200;    ///< Iterations of Bullet that make the states.
  int rounds = 7;       ///< Of each solver on each state.
  int most = 5000;      ///< Iterations of Bullet that are followed.
  int reference = static_cast<int>(kReferenceWork / 1e6);  ///< Millions of relaxations of rows.
};

/// What of Bullet's time is Cairn's budget.
enum class Share {
  kWhole,       ///< All that its solver takes: set-up, iterations, write-back.
  kIterations,  ///< Only the iterations.
};
inline constexpr std::array kShares = {Share::kWhole, Share::kIterations};
inline constexpr std::array kKinds = {Kind::kSweeps, Kind::kSteps};

/// One state and what everyone made of it.
struct StateResult {
  int frame = 0, bodies = 0, rows = 0;
  BulletTime bullet_time;         ///< Medians.
  VelocityDistance bullet_error;  ///< After StatesOptions::iterations.
  VelocityDistance start_error;   ///< Of the warm start, before any iteration.
  int followed = 0;               ///< Iterations of Bullet that were looked at,
  VelocityDistance last_error;    ///< and its error after them.
  Converged reference;            ///< Less its velocities.
  double floor = 0;               ///< SolveFloor() [ms].
  std::array<std::array<CairnResult, kKinds.size()>, kShares.size()> cairn;

  const CairnResult& Of(Share share, Kind kind) const {
    return cairn[static_cast<size_t>(share)][static_cast<size_t>(kind)];
  }
  /// [ms]
  double Budget(Share share) const {
    return share == Share::kWhole ? bullet_time.total() : bullet_time.iterations;
  }
  /// Smallest rms of anyone.
  double LeastError() const;
  /// Steps are worse than sweeps alone by more than sweeps differ from round to round and
  /// solutions from one another.
  bool WorseThanSweeps(Share share) const;
};

struct SceneStates {
  cli::SceneChoice scene;
  std::vector<StateResult> states;
  int empty = 0;  ///< Samples in which nothing touched.
};

/// @param show  is told what is being done
SceneStates MeasureStates(const cli::SceneChoice& scene, const StatesOptions& options,
                          const std::function<void(const std::string&)>& show);

}  // namespace cairn::accuracy
