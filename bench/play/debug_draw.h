// SPDX-License-Identifier: MIT
#pragma once

#include "scenes/world.h"

namespace cairn::play {

/// Shows what a solver does in the picture of a game: implement two functions with whatever draws
/// lines there. Metres, world axes; colours are 0xRRGGBB.
class DebugDraw {
 public:
  struct Point {
    float x, y, z;
  };
  virtual ~DebugDraw() = default;
  virtual void Line(const Point& from, const Point& to, unsigned colour) = 0;
  virtual void Dot(const Point& at, unsigned colour) = 0;
};

/// Points of contact, and what pushes there: a line as long as the impulse would lift the mass of
/// the lighter body in a step, times 0.3 m, at most 1.5 m.
void DrawContacts(const bench::World& world, DebugDraw* draw);

/// Joints: from each body to its anchor, and the gap between anchors in red.
void DrawJoints(const bench::World& world, DebugDraw* draw);

}  // namespace cairn::play
