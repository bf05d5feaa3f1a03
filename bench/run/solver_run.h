// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "contestants/contestant.h"
#include "contestants/watched_solver.h"
#include "effort/iteration_fit.h"
#include "run/frame_writer.h"
#include "run/options.h"
#include "run/result.h"
#include "run/scene_choice.h"

namespace cairn::cli {

/// One solver in a world of its own.
class SolverRun {
 public:
  SolverRun(const SceneChoice& scene, const SolverChoice& choice, const RunOptions& options);

  enum class Observing { kOn, kOff };
  /// One frame of 1/60 s. Nothing once the solver has failed.
  void Step(Observing observing);
  /// Hands the next substep to a probe, island by island: what is too large for a solver of dense
  /// matrices must not depend on how the world of another solver packs islands.
  void ProbeNext(bench::InstrumentedSolver::Probe probe);

  /// Writes what the solver is given in the next frame to a file; see FrameWriter.
  void RecordNext(const std::string& path, int frame);
  std::string TakeRecording() { return writer_.Take(); }

  bool failed() const { return result_.failure.has_value(); }
  /// Why it failed; empty if it did not.
  std::string failure() const { return failed() ? result_.failure->reason : ""; }
  /// Its solver, if that is Cairn's.
  bullet::ConstraintSolver* cairn() { return contestant_->cairn(); }
  /// What the solver may spend on the next frame.
  const Effort& effort() const { return effort_; }
  const std::string& label() const { return result_.label; }
  const bench::World& world() const { return world_; }
  const bench::Scene& scene() const { return *scene_; }
  /// Settings of the world before the solver changed them.
  const btContactSolverInfo& defaults() const { return defaults_; }

  /// Keeps what happened in the last frame, if it is the one to be shown: frames that the run was
  /// disturbed in are not.
  void KeepTimeline(std::optional<int> wanted);
  bool bullet_has_zones() const { return !timeline_ || timeline_->bullet_has_zones(); }

  /// Adds the velocity error of a sample [m/s].
  void AddError(double error) { result_.velocity_errors.push_back(error); }
  /// Adds what more and more effort came to on a sample.
  void AddCurve(std::vector<CurvePoint> curve) { result_.curves.push_back(std::move(curve)); }
  /// The result with what became of the scene. Once, after the last frame.
  SolverResult Finish();

 private:
  void Prepare(Observing observing);
  void Record(std::chrono::nanoseconds time);

  std::unique_ptr<Contestant> contestant_;
  WatchedSolver watched_;
  bench::World world_;
  std::unique_ptr<bench::Scene> scene_;
  btContactSolverInfo defaults_;
  std::optional<IterationFit> fit_;
  Effort effort_;
  int parts_;  ///< of a time step, see SolverEntry
  bool probing_ = false;
  Frame observed_;  ///< What observing found in this frame: residual, rows, islands.
  FrameWriter writer_;
  std::optional<AnimationRecorder> animation_;
  std::optional<TimelineRecorder> timeline_;
  SolverResult result_;
};

}  // namespace cairn::cli
