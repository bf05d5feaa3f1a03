// SPDX-License-Identifier: MIT
// Piles in pits, and bodies that many others hang on or lie on.
#include <cmath>

#include "worlds/kinds/parts.h"

namespace cairn::bench {
namespace {

/// Calls `add` with places on a grid in a pit, `pitch` apart, a little irregular.
template <class AddBody>
void FillPit(Draft* draft, int bodies, btScalar pitch, AddBody add) {
  draft->Ground();
  const int across = 2 + draft->Choose(3);
  const btScalar half = pitch * btScalar(across) * btScalar(0.6), thick = btScalar(0.5);
  for (const btScalar side : {btScalar(-1), btScalar(1)}) {
    const btVector3 x_wall(thick, 1, half + 2 * thick), z_wall(half + 2 * thick, 1, thick);
    draft->Box(x_wall, 0, At(side * (half + thick), 1, 0));
    draft->Box(z_wall, 0, At(0, 1, side * (half + thick)));
  }
  for (int i = 0; i < bodies; ++i) {
    const int layer = i / (across * across), cell = i % (across * across);
    const btScalar jitter = pitch * btScalar(0.05);
    const btVector3 shift = draft->random()->InCube(jitter);
    const btVector3 at(pitch * (btScalar(cell % across) - btScalar(across - 1) / 2),
                       pitch * (btScalar(layer) + btScalar(0.6)),
                       pitch * (btScalar(cell / across) - btScalar(across - 1) / 2));
    add(at + shift);
  }
}

btTransform Turned(Draft* draft, const btVector3& at) {
  const btVector3 axis = draft->random()->InCube(1) + btVector3(0, btScalar(1.1), 0);
  const btScalar angle = draft->Draw(0, 6);
  return btTransform(btQuaternion(axis.normalized(), angle), at);
}

struct Grain {
  int bodies;
  btScalar radius, mass, least, most;  ///< Mass ratios within [least, most].
};

Grain DrawGrain(Draft* draft) {
  Grain grain;
  grain.bodies = draft->Count(5, 60);
  grain.radius = draft->Draw(0.15, 0.5);
  grain.mass = draft->DrawRatio(0.5, 5);
  const bool alike = draft->Chance(0.5);
  grain.least = btScalar(alike ? 0.9 : 0.3);
  grain.most = btScalar(alike ? 1.1 : 200);
  return grain;
}

btScalar DrawMass(Draft* draft, const Grain& grain) {
  return grain.mass * draft->DrawRatio(grain.least, grain.most);
}

}  // namespace

void DrawPileOfBoxes(Draft* draft) {
  const Grain grain = DrawGrain(draft);
  const btScalar x = draft->Draw(0.5, 1), y = draft->Draw(0.3, 1), z = draft->Draw(0.5, 1);
  const btVector3 half = grain.radius * btScalar(0.57) * btVector3(x, y, z);
  FillPit(draft, grain.bodies, 2 * grain.radius * btScalar(1.2), [&](const btVector3& at) {
    const btScalar mass = DrawMass(draft, grain);
    draft->Box(half, mass, Turned(draft, at));
  });
}

void DrawPileOfBalls(Draft* draft) {
  const Grain grain = DrawGrain(draft);
  FillPit(draft, grain.bodies, 2 * grain.radius * btScalar(1.2),
          [&](const btVector3& at) { draft->Sphere(grain.radius, DrawMass(draft, grain), at); });
}

void DrawPileOfHulls(Draft* draft) {
  Grain grain = DrawGrain(draft);
  grain.bodies = (grain.bodies + 1) / 2;  // they cost more
  FillPit(draft, grain.bodies, 2 * grain.radius * btScalar(1.3), [&](const btVector3& at) {
    const btScalar mass = DrawMass(draft, grain);
    draft->Hull(grain.radius, mass, Turned(draft, at));
  });
}

void DrawPileOfCapsules(Draft* draft) {
  const Grain grain = DrawGrain(draft);
  const btScalar share = draft->Draw(0.25, 0.6);
  FillPit(draft, grain.bodies, 2 * grain.radius * btScalar(1.2), [&](const btVector3& at) {
    const btScalar mass = DrawMass(draft, grain);
    draft->Capsule(share * grain.radius, 2 * (1 - share) * grain.radius, mass, Turned(draft, at));
  });
}

void DrawPileOfAll(Draft* draft) {
  Grain grain = DrawGrain(draft);
  grain.bodies = (2 * grain.bodies + 2) / 3;
  grain.least = btScalar(0.001) * 32;
  grain.most = btScalar(32);
  FillPit(draft, grain.bodies, 2 * grain.radius * btScalar(1.25),
          [&](const btVector3& at) { draft->Thing(grain.radius, DrawMass(draft, grain), at); });
}

void DrawJointedHub(Draft* draft) {
  draft->Ground();
  const int spokes = draft->CountOfHub(3, 50);
  const bool held = draft->Chance(0.3);
  const btScalar radius = draft->Draw(0.05, 0.15), mass = draft->DrawRatio(0.1, 3);
  const btScalar hub = std::max(radius * btScalar(spokes) / 3, btScalar(0.4));
  const btScalar length = draft->Draw(0.4, 1);
  const Hold hold = DrawHold(draft);
  const btVector3 middle(0, hub + 2 * length + draft->Draw(0, 1), 0);
  const btScalar hub_mass = held ? 0 : mass * draft->DrawRatio(0.3, 200);
  btRigidBody* const body = draft->Box(btVector3(hub, btScalar(0.2), hub), hub_mass,
                                       At(middle.x(), middle.y(), middle.z()));
  for (int i = 0; i < spokes; ++i) {
    const btScalar angle = SIMD_2_PI * btScalar(i) / btScalar(spokes);
    const btVector3 out(std::cos(angle), 0, std::sin(angle));
    const btVector3 at = middle + (hub * btScalar(1.45)) * out;
    btRigidBody* const spoke = draft->Box(btVector3(length / 2, radius / 2, radius / 2), mass,
                                          FrameAlongX(at + length / 2 * out, out));
    Connect(draft, hold, body, spoke, {at, btVector3(-out.z(), 0, out.x()), out, radius / 2});
  }
}

void DrawTouchedHub(Draft* draft) {
  draft->Ground();
  const int bodies = draft->CountOfHub(4, 50);
  const int across = static_cast<int>(std::ceil(std::sqrt(bodies)));
  const btScalar half = draft->Draw(0.1, 0.25), pitch = half * draft->Draw(2.1, 3);
  const btScalar side = pitch * btScalar(across) / 2 + half, mass = draft->DrawRatio(0.3, 5);
  btScalar y = half / 2;
  // Under boxes, under balls, or on a narrow foot that it tilts on.
  const int foot = draft->Choose(3);
  if (foot == 2) {
    draft->Box(btVector3(side / 3, half, side / 3), 0, At(0, half, 0));
    y += 2 * half;
  }
  const btScalar hub_mass = mass * draft->DrawRatio(0.01, 100);
  draft->Box(btVector3(side, half / 2, side), hub_mass, At(0, y, 0));
  for (int i = 0; i < bodies; ++i) {
    const btScalar x = pitch * (btScalar(i % across) - btScalar(across - 1) / 2);
    const btScalar z = pitch * (btScalar(i / across) - btScalar(across - 1) / 2);
    const btVector3 at(x, y + half * btScalar(1.5) + btScalar(0.001), z);
    if (foot == 1) {
      draft->Sphere(half, mass, at);
    } else {
      draft->Box(btVector3(half, half, half), mass, At(at.x(), at.y(), at.z()));
    }
  }
}

}  // namespace cairn::bench
