// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "measure/contact_frame.h"
#include "measure/instrumented_solver.h"
#include "measure/row_recorder.h"
#include "run/scene_choice.h"
#include "scenes/scene.h"
#include "scenes/world.h"

namespace cairn::cli {

/// A scene under Bullet's stock solver, whose states others are given.
class StateRun {
 public:
  /// @param iterations  of the solver that makes the states
  StateRun(const SceneChoice& choice, int iterations);

  /// Makes a step.
  void Step();
  /// Makes a step and keeps its rows.
  bench::ContactFrame Record();
  /// Makes a step, but shows its state first.
  void StepAfter(bench::InstrumentedSolver::Probe probe);

  int frame() const { return frame_; }  ///< Steps made.

 private:
  bench::RowRecorder solver_;
  bench::InstrumentedSolver instrumented_{&solver_};
  bench::World world_{&instrumented_};
  std::unique_ptr<bench::Scene> scene_;
  int frame_ = 0;
};

}  // namespace cairn::cli
