// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
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

}  // namespace cairn::accuracy
