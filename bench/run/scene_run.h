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

/// A scene in a world of its own, frame by frame.
class BuiltScene {
 public:
  /// @param solver  is not owned
  BuiltScene(const SceneChoice& choice, btConstraintSolver* solver);

  /// @param parts  that Bullet takes the step in
  void Step(int parts = 1);

  int frame() const { return frame_; }  ///< Steps made.
  bench::World& world() { return world_; }

 private:
  bench::World world_;
  SceneChoice choice_;  ///< What the scene was made from lives as long as it does.
  std::unique_ptr<bench::Scene> scene_;
  int frame_ = 0;
};

/// A scene that a solver drives, timed.
class SceneRun {
 public:
  /// @param driver  is not owned
  SceneRun(const SceneChoice& choice, btConstraintSolver* driver);

  void Step() { scene_.Step(); }
  void Skip(int frames);
  /// Makes a step, but shows its state first.
  void StepAfter(bench::InstrumentedSolver::Probe probe);

  int frame() const { return scene_.frame(); }  ///< Steps made.
  bench::World& world() { return scene_.world(); }
  /// See bench::InstrumentedSolver.
  std::chrono::nanoseconds TakeTime() { return instrumented_.TakeTime(); }

 private:
  bench::InstrumentedSolver instrumented_;
  BuiltScene scene_;
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
