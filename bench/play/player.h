// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contestants/solver_registry.h"
#include "contestants/watched_solver.h"
#include "play/played_world.h"
#include "run/frame_writer.h"

namespace cairn::play {

/// What a step came to.
struct Sample {
  double solver_ms = 0;  ///< In the solver.
  double world_ms = 0;   ///< The rest of Bullet's step: collisions, islands, motion.
  /// Of solver_ms in Cairn: reading Bullet's objects, solving, writing back.
  double build_ms = 0, solve_ms = 0, write_ms = 0;
  double residual = 0;  ///< [m/s], of the last step that was measured.
  /// Of the world [J], [m], [m]. NaN where it is not known: of recordings, without joints.
  double energy = 0, penetration = 0, joint_gap = 0;
  int sweeps = 0, steps_kept = 0, steps_undone = 0, guarded = 0;
  int asleep = 0;  ///< Bodies.
};

/// One world with one solver, which may be changed while it runs.
class Player {
 public:
  /// @throws cli::Failure as MakePlayedWorld() does
  Player(const Controls& controls, const PlayerControls& own);
  ~Player();

  /// Takes over what may change at any time.
  void Apply(const Controls& controls, const PlayerControls& own);
  /// @param budget  [ns] for a solver with a clock; none: its iterations decide
  void Step(std::optional<std::chrono::nanoseconds> budget);

  /// A ball, with a velocity [m/s].
  void Shoot(const btVector3& from, const btVector3& velocity, double mass);
  /// Pins a body softly where it is at a point in the world; Move() pulls it elsewhere. Recordings
  /// stay as they are.
  void Grab(int body, const btVector3& at);
  void Move(const btVector3& to);
  void Release();
  /// The dynamic body and the point that a ray meets first; -1: none.
  int Pick(const btVector3& from, const btVector3& to, btVector3* at) const;
  /// Writes the problem of the next step to a file; see docs/recording.md.
  void SaveNext(const std::string& path);
  /// What became of it; before the step, its path.
  const std::string& saved() const { return saved_; }

  const bench::World& world() const { return played_->world(); }
  PlayedWorld& played() { return *played_; }
  const cli::SolverEntry& solver() const { return *entry_; }
  bullet::ConstraintSolver* cairn() { return contestant_->cairn(); }
  /// What Cairn was told; nullptr of Bullet's solvers.
  const Settings* settings();
  int frame() const { return frame_; }
  /// Why it stopped; empty while it runs.
  const std::string& failure() const { return failure_; }
  /// The last ones, the newest last.
  const std::vector<Sample>& history() const { return history_; }
  /// Mean time of the solver over the last half second [ms].
  double MeanSolverTime() const;
  /// What Cairn reported about the island of a dynamic body; none of Bullet's solvers.
  std::optional<IslandReport> ReportOf(int body);
  /// Where a body is to be drawn, a share in [0, 1] of a step after the last but one.
  btTransform Pose(const btRigidBody& body, btScalar share) const;

  static constexpr size_t kMostHistory = 300;

 private:
  void SetSolver(const std::string& name);
  void Observe();
  void SolveRecording();
  void Take(std::chrono::nanoseconds all);
  void Keep(const Sample& sample);

  const cli::SolverEntry* entry_ = nullptr;
  std::unique_ptr<cli::Contestant> contestant_;
  std::unique_ptr<cli::WatchedSolver> watched_;
  std::unique_ptr<PlayedWorld> played_;
  btContactSolverInfo defaults_;
  cli::Effort effort_;
  PlayerControls own_;
  int frame_ = 0, substeps_ = 1;
  bool measure_ = true, sleep_ = false, observing_ = false;
  double residual_ = 0;
  std::vector<Sample> history_;
  std::vector<btTransform> before_;  ///< By index in the world's array of objects.
  std::unique_ptr<btPoint2PointConstraint> pin_;
  cli::FrameWriter writer_;
  std::string saved_, failure_;
};

}  // namespace cairn::play
