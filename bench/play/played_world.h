// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "play/controls.h"
#include "rows/frame_world.h"
#include "scenes/scene.h"

namespace cairn::play {

/// A world and what happens to it from outside, whatever it comes from.
class PlayedWorld {
 public:
  virtual ~PlayedWorld() = default;
  virtual bench::World& world() = 0;
  const bench::World& world() const { return const_cast<PlayedWorld*>(this)->world(); }
  /// The next frame, in so many parts.
  virtual void Step(int parts) = 0;
  /// Whether length and parts of steps are its own.
  virtual bool has_own_steps() const { return false; }
  /// What the world is made of, if that is a recording: it does not move.
  virtual cli::FrameWorld* recorded() { return nullptr; }
};

/// @pre `solver` outlives the world, or another one takes its place
/// @throws cli::Failure for a scene, size or file that is not there
std::unique_ptr<PlayedWorld> MakePlayedWorld(const SceneControls& scene,
                                             btConstraintSolver* solver);

}  // namespace cairn::play
