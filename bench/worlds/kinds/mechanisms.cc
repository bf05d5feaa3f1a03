// SPDX-License-Identifier: MIT
// Sliders, cone-twist joints, gears, fixed joints.
#include <cmath>

#include "worlds/kinds/parts.h"

namespace cairn::bench {

void DrawSliders(Draft* draft) {
  draft->Ground();
  const int count = draft->Count(1, 10);
  const bool stacked = draft->Chance(0.5);
  const btScalar half = draft->Draw(0.2, 0.4), mass = draft->DrawRatio(0.5, 10);
  const btScalar height = half * btScalar(2.2) * btScalar(count) + 2;
  btRigidBody* const rail = draft->Box(btVector3(half, half, half), 0, At(0, height + 2 * half, 0));
  btRigidBody* previous = rail;
  for (int i = 0; i < count; ++i) {
    const btScalar x = stacked ? 0 : btScalar(2.5) * half * btScalar(i);
    const btScalar y = height - (stacked ? btScalar(2.2) * half * btScalar(i) : 0);
    btRigidBody* const body =
        draft->Box(btVector3(half, half, half), mass * draft->DrawRatio(0.3, 30), At(x, y, 0));
    // Sliders slide along x of their frame: level, sloping, or upright.
    const btScalar slope = draft->Chance(0.3) ? SIMD_HALF_PI : draft->Draw(-0.6, 0.6);
    const btTransform frame(btQuaternion(btVector3(0, 0, 1), slope), btVector3(x, y, 0));
    auto* const slider = draft->Add(std::make_unique<btSliderConstraint>(
        *previous, *body, Local(*previous, frame), Local(*body, frame), true));
    const btScalar reach = draft->Draw(0.1, 1);
    slider->setLowerLinLimit(-reach);
    slider->setUpperLinLimit(reach);
    slider->setLowerAngLimit(draft->Chance(0.5) ? 0 : btScalar(-0.5));
    slider->setUpperAngLimit(slider->getLowerAngLimit() == 0 ? 0 : btScalar(0.5));
    if (draft->Chance(0.4)) {
      slider->setPoweredLinMotor(true);
      slider->setTargetLinMotorVelocity(draft->Draw(-2, 2));
      slider->setMaxLinMotorForce(mass * draft->DrawRatio(1, 100));
    }
    previous = stacked ? body : rail;
  }
}

void DrawConeTwists(Draft* draft) {
  draft->Ground();
  const int links = draft->Count(2, 16), chains = draft->Count(1, 3);
  const btScalar length = draft->Draw(0.25, 0.6), radius = length * draft->Draw(0.1, 0.25);
  const btScalar swing = draft->Draw(0.05, 0.8), twist = draft->Draw(0.01, 0.5);
  const btScalar growth = std::pow(draft->DrawRatio(0.1, 100), 1 / btScalar(links));
  const bool level = draft->Chance(0.5), held = draft->Chance(0.7);
  for (int n = 0; n < chains; ++n) {
    const btVector3 way = level ? btVector3(1, 0, 0) : btVector3(0, -1, 0);
    const btScalar top = (level ? 1 : length * btScalar(links)) + btScalar(0.3);
    const std::vector<btVector3> line =
        Straight(btVector3(0, top, btScalar(n)), length * way, links);
    btScalar mass = draft->DrawRatio(0.3, 3);
    btRigidBody* previous = nullptr;
    for (int i = 0; i < links; ++i, mass *= growth) {
      const btTransform pose = FrameAlongX((line[i] + line[i + 1]) / 2, way) *
                               btTransform(btQuaternion(btVector3(0, 0, 1), SIMD_HALF_PI));
      btRigidBody* const link =
          draft->Capsule(radius, length - 2 * radius, held && i == 0 ? 0 : mass, pose);
      if (previous != nullptr) {
        Cone(draft, previous, link, FrameAlongX(line[i], way))->setLimit(swing, swing, twist);
      }
      previous = link;
    }
  }
}

void DrawGears(Draft* draft) {
  draft->Ground();
  const int wheels = draft->Count(2, 8);
  const btScalar mass = draft->DrawRatio(0.5, 10), speed = draft->Draw(-8, 8);
  btRigidBody* const board = draft->Box(btVector3(10, 2, btScalar(0.1)), 0, At(0, 3, 0));
  btRigidBody* previous = nullptr;
  btScalar x = 0, last_radius = 0;
  for (int i = 0; i < wheels; ++i) {
    const btScalar radius = draft->Draw(0.2, 0.6);
    x += i == 0 ? 0 : last_radius + radius + btScalar(0.02);
    const btVector3 at(x, 3, btScalar(0.3));
    const btTransform pose(btQuaternion(btVector3(1, 0, 0), SIMD_HALF_PI), at);
    btRigidBody* const wheel =
        draft->Cylinder(radius, btScalar(0.2), mass * draft->DrawRatio(0.1, 10), pose);
    btHingeConstraint* const axle = Hinge(draft, board, wheel, FrameAlongZ(at, btVector3(0, 0, 1)));
    if (i == 0) {
      axle->enableAngularMotor(true, speed, mass * draft->DrawRatio(0.01, 0.3));
    } else {
      // The axes of both, each in its body: y of a cylinder.
      draft->Add(std::make_unique<btGearConstraint>(*previous, *wheel, btVector3(0, 1, 0),
                                                    btVector3(0, 1, 0), radius / last_radius));
    }
    // A weight on its rim, which it lifts and lets down.
    if (draft->Chance(0.5)) {
      const btVector3 rim = at + btVector3(0, -radius * btScalar(0.8), btScalar(0.25));
      btRigidBody* const weight = draft->Sphere(radius / 4, mass * draft->DrawRatio(0.03, 3), rim);
      Pin(draft, wheel, weight, rim);
    }
    previous = wheel;
    last_radius = radius;
  }
}

void DrawFixedFrame(Draft* draft) {
  draft->Ground();
  const int columns = draft->Count(2, 5), rows = draft->Count(1, 4);
  const btScalar half = draft->Draw(0.15, 0.3), mass = draft->DrawRatio(0.3, 10);
  const btScalar height = half + draft->Draw(0, 2);
  const bool braced = draft->Chance(0.5), held = draft->Chance(0.4);
  std::vector<btRigidBody*> boxes;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const btVector3 at(2 * half * btScalar(c), height + 2 * half * btScalar(r), 0);
      const bool is_static = held && c == 0;
      boxes.push_back(draft->Box(btVector3(half, half, half),
                                 is_static ? 0 : mass * draft->DrawRatio(0.3, 3),
                                 At(at.x(), at.y(), at.z())));
      const size_t self = boxes.size() - 1;
      if (c > 0) Fix(draft, boxes[self - 1], boxes[self], at - btVector3(half, 0, 0));
      const bool both_static = is_static && r > 0;
      if (r > 0 && (braced || c == 0) && !both_static) {
        Fix(draft, boxes[self - columns], boxes[self], at - btVector3(0, half, 0));
      }
    }
  }
  const btScalar top = height + 2 * half * btScalar(rows);
  draft->Thing(half * 2, mass * draft->DrawRatio(0.3, 100),
               btVector3(half * btScalar(columns), top + 2 * half, 0));
}

}  // namespace cairn::bench
