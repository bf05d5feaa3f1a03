// SPDX-License-Identifier: MIT
#pragma once

#include "scenes/random.h"
#include "scenes/world.h"

namespace cairn::bench {

/// Two kinematic plates close on all bodies, up and down or from two sides, as doors, lifts and
/// crushers of games do. They start at the box around the bodies, go at 0.3 to 2 m/s each until a
/// share of the room is left, 0.3 to 0.95 of it, or for 1.5 s, stay for up to half a second, and
/// open again. Then the next press begins. They do the same with every solver, but for the box that
/// they start at.
class Press {
 public:
  /// The surface of its plates.
  Press(Random random, const Surface& surface) : random_(random), surface_(surface) {}

  /// Before a step of that length [s].
  void Act(double time_step, World* world);

 private:
  enum class Phase { kOpen, kCloses, kStays, kOpens };

  void Begin(World* world);
  void MoveTo(btScalar closed);

  Random random_;
  Surface surface_;
  Phase phase_ = Phase::kOpen;
  double left_ = 0.3;                            ///< of this phase [s]
  double closing_ = 0, staying_ = 0;             ///< how long [s]
  double speed_ = 0;                             ///< of each plate [m/s]
  double closed_ = 0;                            ///< how far each plate has gone [m]
  btRigidBody* plates_[2] = {nullptr, nullptr};  ///< low and high; World keeps them
  btVector3 starts_[2];                          ///< where their centres were
  btVector3 direction_{0, 0, 0};                 ///< of the low one
};

}  // namespace cairn::bench
