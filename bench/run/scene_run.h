// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <memory>

#include "measure/contact_frame.h"
#include "measure/instrumented_solver.h"
#include "measure/row_recorder.h"
#include "run/scene_choice.h"
#include "scenes/scene.h"
#include "scenes/world.h"

namespace cairn::cli {

/// A scene that a solver drives, frame by frame.
class SceneRun {
 public:
  /// @param driver  is not owned
  SceneRun(const SceneChoice& choice, btConstraintSolver* driver);

  void Step();
  void Skip(int frames);
  /// Makes a step, but shows its state first.
  void StepAfter(bench::InstrumentedSolver::Probe probe);

  int frame() const { return frame_; }  ///< Steps made.
  bench::World& world() { return world_; }
  /// See bench::InstrumentedSolver.
  std::chrono::nanoseconds TakeTime() { return instrumented_.TakeTime(); }

 private:
  bench::InstrumentedSolver instrumented_;
  bench::World world_;
  std::unique_ptr<bench::Scene> scene_;
  int frame_ = 0;
};

/// A scene under Bullet's stock solver, whose states others are given: all islands as one problem.
class StateRun {
 public:
  /// @param iterations  of the solver that makes the states
  explicit StateRun(const SceneChoice& choice, int iterations = 10);

  void Step() { run_.Step(); }
  void Skip(int frames) { run_.Skip(frames); }
  void StepAfter(bench::InstrumentedSolver::Probe probe) { run_.StepAfter(std::move(probe)); }
  int frame() const { return run_.frame(); }
  /// Makes a step and keeps its rows, impulses as the warm start left them, as the adapter sees it.
  /// @throws std::runtime_error if nothing touches
  bench::ContactFrame Record();

 private:
  bench::RowRecorder solver_;
  SceneRun run_;
};

}  // namespace cairn::cli
