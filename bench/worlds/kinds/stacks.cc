// SPDX-License-Identifier: MIT
// Towers, walls, pyramids, and what is heavy on what is light.
#include "worlds/kinds/stacks.h"

#include <algorithm>
#include <cmath>

namespace cairn::bench {

void AddWall(Draft* draft, const WallSize& size) {
  const btVector3 brick(2 * size.half, size.half, size.half);
  const btScalar pitch = btScalar(4.02) * size.half;
  for (int course = 0; course < size.courses; ++course) {
    const btScalar shift = course % 2 == 0 ? 0 : pitch / 2;
    for (int i = 0; i < size.columns; ++i) {
      const btScalar x = pitch * (btScalar(i) - btScalar(size.columns) / 2) + shift;
      draft->Box(brick, size.mass, At(x, size.half * btScalar(2 * course + 1), 0));
    }
  }
}

std::vector<btRigidBody*> AddStack(Draft* draft, const StackSize& size, const btVector3& foot) {
  constexpr double kShift = 0.006;  // [m]
  std::vector<btRigidBody*> boxes;
  btScalar mass = size.mass;
  for (int i = 0; i < size.boxes; ++i, mass *= size.growth) {
    const btVector3 shift = draft->random()->InCube(kShift);
    boxes.push_back(draft->Box(btVector3(size.half, size.half, size.half), mass,
                               At(foot.x() + shift.x(), foot.y() + size.half * btScalar(2 * i + 1),
                                  foot.z() + shift.z())));
  }
  return boxes;
}

void DrawTower(Draft* draft) {
  draft->Ground();
  const int boxes = draft->Count(3, 24), towers = draft->Chance(0.3) ? draft->Count(2, 4) : 1;
  const btScalar ratio = draft->DrawRatio(0.3, 200), half = draft->Draw(0.15, 0.5);
  const btScalar growth = std::pow(ratio, 1 / btScalar(boxes));
  for (int i = 0; i < towers; ++i) {
    AddStack(draft, {boxes, half, draft->DrawRatio(0.5, 5), growth},
             btVector3(btScalar(i) * 4 * half, 0, 0));
  }
}

void DrawHeavyOnLight(Draft* draft) {
  draft->Ground();
  const btScalar half = draft->Draw(0.15, 0.4), light = draft->DrawRatio(0.3, 5);
  const int boxes = draft->Count(1, 12), stacks = draft->Count(1, 4);
  const btScalar ratio =
      draft->Chance(0.3) ? draft->DrawRatio(0.001, 1000) : draft->DrawRatio(2, 200);
  for (int i = 0; i < stacks; ++i) {
    const btVector3 foot(btScalar(i) * 5 * half, 0, 0);
    AddStack(draft, {boxes, half, light, 1}, foot);
    const btScalar top = 2 * half * btScalar(boxes), size = half * draft->Draw(0.7, 1.5);
    draft->Box(btVector3(size, size, size), light * ratio, At(foot.x(), top + size, 0));
  }
}

void DrawSlab(Draft* draft) {
  draft->Ground();
  const int across = draft->Count(2, 5), along = draft->Count(2, 5), boxes = draft->Count(1, 3);
  const btScalar half = draft->Draw(0.1, 0.2), light = draft->DrawRatio(0.3, 3), pitch = 5 * half;
  for (int i = 0; i < across; ++i) {
    for (int k = 0; k < along; ++k) {
      AddStack(draft, {boxes, half, light, 1},
               btVector3(pitch * btScalar(i), 0, pitch * btScalar(k)));
    }
  }
  const btVector3 slab(pitch * btScalar(across) / 2, half, pitch * btScalar(along) / 2);
  draft->Box(slab, light * draft->DrawRatio(2, 500),
             At(pitch * btScalar(across - 1) / 2, half * btScalar(2 * boxes + 1),
                pitch * btScalar(along - 1) / 2));
}

void DrawShotWall(Draft* draft) {
  draft->Ground();
  const int columns = draft->Count(2, 8), courses = draft->Count(2, 9);
  const btScalar half = draft->Draw(0.1, 0.25), brick = draft->DrawRatio(0.5, 5);
  AddWall(draft, {.columns = columns, .courses = courses, .half = half, .mass = brick});
  const int shots = draft->Count(1, 3);
  for (int i = 0; i < shots; ++i) {
    const btScalar radius = draft->Draw(0.1, 0.4), mass = brick * draft->DrawRatio(0.3, 60);
    const btScalar speed = draft->Draw(5, 20), x = draft->Draw(-0.4, 0.4) * btScalar(columns);
    const btVector3 from(x * 4 * half, radius + btScalar(0.5), 4 + 2 * btScalar(i));
    const Surface surface = draft->rules()->surface;
    draft->At(0.5 + i, [=](World* world) {
      btRigidBody* const ball = world->AddSphere(
          radius, {.mass = mass, .pose = At(from.x(), from.y(), from.z()), .surface = surface});
      ball->setLinearVelocity(btVector3(0, 1, -speed));
    });
  }
}

void DrawPyramid(Draft* draft) {
  draft->Ground();
  const int base = draft->Count(2, 9);
  const btScalar half = draft->Draw(0.15, 0.4), mass = draft->DrawRatio(0.5, 5);
  const btScalar gap = half * draft->Draw(2.02, 2.4);
  const bool load = draft->Chance(0.4);
  for (int row = 0; row < base; ++row) {
    for (int i = 0; i < base - row; ++i) {
      const btScalar x = gap * (btScalar(i) - btScalar(base - row - 1) / 2);
      const bool top = load && row == base - 1;
      draft->Box(btVector3(half, half, half), top ? mass * draft->DrawRatio(1, 200) : mass,
                 At(x, half * btScalar(2 * row + 1), 0));
    }
  }
}

}  // namespace cairn::bench
