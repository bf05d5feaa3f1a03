// SPDX-License-Identifier: MIT
// Ragdolls: capsules on cone-twist joints and hinges with limits.
#include <array>
#include <cmath>

#include "worlds/kinds/parts.h"

namespace cairn::bench {
namespace {

// A doll of 1.7 m stands upright with its feet at y = 0 and its arms along x.
struct Part {
  double x, y, radius, length, mass;  // [m], [kg]
  bool lies;                          // along x instead of y
};
constexpr Part kParts[] = {
    {0, 0.98, 0.13, 0.12, 12, false},    {0, 1.28, 0.13, 0.20, 20, false},
    {0, 1.64, 0.10, 0.05, 5, false},     {-0.13, 0.66, 0.07, 0.30, 8, false},
    {-0.13, 0.24, 0.06, 0.28, 4, false}, {0.13, 0.66, 0.07, 0.30, 8, false},
    {0.13, 0.24, 0.06, 0.28, 4, false},  {-0.36, 1.42, 0.055, 0.20, 2.5, true},
    {-0.68, 1.42, 0.05, 0.22, 2, true},  {0.36, 1.42, 0.055, 0.20, 2.5, true},
    {0.68, 1.42, 0.05, 0.22, 2, true},
};
constexpr int kPartCount = 11;

struct Bond {
  int a, b;
  double x, y;
  bool cone;
  double low, high;  // of a hinge; swing and twist of a cone [rad]
};
constexpr Bond kBonds[] = {
    {0, 1, 0, 1.12, false, -0.4, 0.8},     {1, 2, 0, 1.52, true, 0.6, 0.8},
    {0, 3, -0.13, 0.86, true, 0.9, 0.4},   {0, 5, 0.13, 0.86, true, 0.9, 0.4},
    {3, 4, -0.13, 0.44, false, 0, 2.2},    {5, 6, 0.13, 0.44, false, 0, 2.2},
    {1, 7, -0.20, 1.42, true, 1.2, 0.6},   {1, 9, 0.20, 1.42, true, 1.2, 0.6},
    {7, 8, -0.52, 1.42, false, -1.5, 1.5}, {9, 10, 0.52, 1.42, false, -1.5, 1.5},
};

void AddDoll(Draft* draft, const btTransform& pose, double weight) {
  std::array<btRigidBody*, kPartCount> bodies;
  const btTransform lying(btQuaternion(btVector3(0, 0, 1), SIMD_HALF_PI));
  for (int i = 0; i < kPartCount; ++i) {
    const Part& part = kParts[i];
    const btTransform at = pose * At(btScalar(part.x), btScalar(part.y), 0);
    bodies[i] = draft->Capsule(btScalar(part.radius), btScalar(part.length),
                               btScalar(part.mass * weight), part.lies ? at * lying : at);
  }
  for (const Bond& bond : kBonds) {
    const bool arm = kParts[bond.b].lies;
    const btVector3 point(btScalar(bond.x), btScalar(bond.y), 0);
    const btVector3 along = arm ? btVector3(1, 0, 0) : btVector3(0, 1, 0);
    if (bond.cone) {
      Cone(draft, bodies[bond.a], bodies[bond.b], pose * FrameAlongX(point, along))
          ->setLimit(btScalar(bond.low), btScalar(bond.low), btScalar(bond.high));
    } else {
      const btVector3 axis = arm ? btVector3(0, 1, 0) : btVector3(1, 0, 0);
      Hinge(draft, bodies[bond.a], bodies[bond.b], pose * FrameAlongZ(point, axis))
          ->setLimit(btScalar(bond.low), btScalar(bond.high));
    }
  }
}

/// Dolls one above another from `bottom` up, lying on their back and turned any way.
void DropDolls(Draft* draft, int dolls, btScalar bottom) {
  for (int i = 0; i < dolls; ++i) {
    const btQuaternion turn(btVector3(0, 1, 0), draft->Draw(0, 6.28));
    const btQuaternion back(btVector3(1, 0, 0), -SIMD_HALF_PI + draft->Draw(-0.2, 0.2));
    const btVector3 aside = draft->random()->InCube(0.5);
    const btTransform pose(turn * back,
                           btVector3(aside.x(), bottom + btScalar(0.9 * i + 0.6), aside.z()));
    AddDoll(draft, pose * At(0, btScalar(-0.95), 0), draft->DrawRatio(0.5, 2));
  }
}

}  // namespace

void DrawDollsOnStairs(Draft* draft) {
  draft->Ground();
  const int steps = draft->Count(3, 10), dolls = draft->Count(1, 3);
  const btScalar rise = draft->Draw(0.15, 0.35), depth = draft->Draw(0.3, 0.6);
  for (int i = 0; i < steps; ++i) {
    const btScalar height = rise * btScalar(steps - i);
    draft->Box(btVector3(depth / 2, height / 2, 2), 0,
               At(depth * (btScalar(i) + btScalar(0.5)) - 1, height / 2, 0));
  }
  DropDolls(draft, dolls, rise * btScalar(steps) + draft->Draw(0.1, 1));
}

void DrawDollsOnPile(Draft* draft) {
  draft->Ground();
  const int things = draft->Count(2, 12), dolls = draft->Count(1, 3);
  const btScalar mass = draft->DrawRatio(0.5, 50);
  for (int i = 0; i < things; ++i) {
    const btScalar x = btScalar(i % 3 - 1), y = btScalar(i / 3), z = draft->Draw(-0.2, 0.2);
    draft->Thing(btScalar(0.45), mass, btVector3(x, y + btScalar(0.5), z));
  }
  DropDolls(draft, dolls, btScalar(things / 3 + 1) + draft->Draw(0.1, 1));
}

}  // namespace cairn::bench
