// SPDX-License-Identifier: MIT
// Loads on ropes.
#include <cmath>

#include "worlds/kinds/parts.h"
#include "worlds/kinds/stacks.h"

namespace cairn::bench {

void DrawCrane(Draft* draft) {
  draft->Ground();
  const btScalar height = draft->Draw(5, 9), reach = draft->Draw(3, 6);
  const int links = draft->Count(3, 14);
  const btScalar link = (height - 2) / btScalar(links) * draft->Draw(0.5, 1);
  btRigidBody* const mast =
      draft->Box(btVector3(btScalar(0.3), height / 2, btScalar(0.3)), 0, At(0, height / 2, 0));
  const btScalar jib_mass = draft->Draw(20, 200), y = height + btScalar(0.25);
  btRigidBody* const jib = draft->Box(btVector3(reach / 2, btScalar(0.2), btScalar(0.2)), jib_mass,
                                      At(reach / 2 - btScalar(0.3), y, 0));
  btHingeConstraint* const turn =
      Hinge(draft, mast, jib, FrameAlongZ(btVector3(0, height, 0), btVector3(0, 1, 0)));
  const btScalar strength = jib_mass * reach * draft->Draw(0.02, 0.2);  // [N m s]
  turn->enableAngularMotor(true, draft->Draw(-0.6, 0.6), strength);
  if (draft->Chance(0.5)) {
    const btScalar back = draft->Draw(-1, 1);
    draft->At(2,
              [turn, back, strength](World*) { turn->enableAngularMotor(true, back, strength); });
  }

  Strand rope;
  rope.hold = DrawHold(draft);
  rope.half_thickness = rope.half_width = link / 8;
  rope.mass = draft->DrawRatio(0.2, 3);
  rope.round = draft->Chance(0.5);
  const btVector3 tip(reach - btScalar(0.5), y - btScalar(0.2), 0);
  const std::vector<btVector3> line = Straight(tip, btVector3(0, -link, 0), links);
  const std::vector<btRigidBody*> bodies = AddStrand(draft, rope, line);
  Pin(draft, jib, bodies.front(), tip);
  const btScalar half = draft->Draw(0.2, 0.5);
  btRigidBody* const load =
      draft->Box(btVector3(half, half, half), draft->Load(rope.mass * draft->DrawRatio(1, 200)),
                 At(tip.x(), line.back().y() - half, 0));
  Connect(draft, draft->Chance(0.5) ? Hold::kPin : Hold::kHinge, bodies.back(), load,
          {line.back(), btVector3(0, 0, 1), btVector3(0, -1, 0), half});
}

void DrawWreckingBall(Draft* draft) {
  draft->Ground();
  const int links = draft->Count(3, 12), courses = draft->Count(3, 6), columns = draft->Count(2, 5);
  const btScalar half = draft->Draw(0.15, 0.3), brick = draft->DrawRatio(0.5, 5);
  const btScalar radius = draft->Draw(0.3, 0.6), angle = draft->Draw(0.6, 1.4);
  const btScalar length = btScalar(2.5) + half * btScalar(courses);
  AddWall(draft, {.columns = columns, .courses = courses, .half = half, .mass = brick});
  Strand rope;
  rope.hold = DrawHold(draft);
  rope.half_thickness = rope.half_width = length / btScalar(links) / 8;
  rope.mass = draft->DrawRatio(0.2, 3);
  rope.first_static = true;
  const btVector3 top(0, length + radius + half * btScalar(courses), half + radius + btScalar(0.3));
  const btVector3 way(0, -std::cos(angle), std::sin(angle));
  const std::vector<btVector3> line = Straight(top, length / btScalar(links) * way, links);
  const std::vector<btRigidBody*> bodies = AddStrand(draft, rope, line);
  btRigidBody* const ball = draft->Sphere(radius, draft->Load(rope.mass * draft->DrawRatio(1, 200)),
                                          line.back() + radius * way);
  Pin(draft, bodies.back(), ball, line.back());
}

}  // namespace cairn::bench
