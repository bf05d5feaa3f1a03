// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "scenes/random.h"
#include "scenes/world.h"

namespace cairn::bench {

/// Somebody drags bodies with a mouse, as in the demos of Bullet: some twice a second he takes hold
/// of one, at a point of the box around its shape, pulls it about by a btPoint2PointConstraint for
/// up to 1.5 s, and lets go. The point goes at up to 2 or 10 m/s along each axis, wherever the body
/// can follow or not. What the joint may pull with is as in the demos, three times the mass of the
/// body a step, or without end. He does the same with every solver. Gaps of a World are without it.
class Mouse {
 public:
  explicit Mouse(Random random) : random_(random) {}
  /// Lets go. @pre the world is still there, or it holds nothing
  ~Mouse();
  Mouse(const Mouse&) = delete;
  Mouse& operator=(const Mouse&) = delete;

  /// Before a step of that length [s].
  void Act(double time_step, World* world);

 private:
  void Take(World* world);
  void Drag(double time_step);
  void LetGo();

  Random random_;
  World* world_ = nullptr;
  std::unique_ptr<btPoint2PointConstraint> joint_;
  btVector3 velocity_{0, 0, 0};  ///< of its end [m/s]
  double left_ = 0;              ///< until it lets go [s]
};

}  // namespace cairn::bench
