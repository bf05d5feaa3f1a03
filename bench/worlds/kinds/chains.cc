// SPDX-License-Identifier: MIT
// Chains and garlands.
#include <algorithm>
#include <cmath>

#include "worlds/kinds/parts.h"

namespace cairn::bench {
namespace {

Strand DrawLinks(Draft* draft, btScalar length) {
  Strand strand;
  strand.hold = DrawHold(draft);
  strand.half_thickness = length * draft->Draw(0.08, 0.2);
  strand.half_width = length * draft->Draw(0.08, 0.3);
  strand.mass = draft->DrawRatio(0.2, 5);
  strand.round = draft->Chance(0.3);
  strand.first_static = true;
  return strand;
}

/// The mass of a load on links of a mass: mostly heavier, sometimes far.
btScalar DrawLoad(Draft* draft, btScalar link) {
  const btScalar ratio =
      draft->Chance(0.1) ? draft->DrawRatio(0.001, 1000) : draft->DrawRatio(0.3, 200);
  return draft->Load(link * ratio);
}

}  // namespace

void DrawChain(Draft* draft) {
  draft->Ground();
  const btScalar length = draft->Draw(0.2, 0.6), angle = draft->Draw(0, 1.6);
  const int links = draft->Count(3, 26);
  const Strand strand = DrawLinks(draft, length);
  const btScalar radius = draft->Draw(0.2, 0.5);
  // High enough to be clear of the floor at the start; when it swings down it may hit it.
  const btScalar hangs = std::cos(angle) * length * btScalar(links);
  const btScalar top =
      std::max(hangs, length * btScalar(links) * draft->Draw(0.7, 1.2)) + 3 * radius;
  const std::vector<btVector3> line = Straight(
      btVector3(0, top, 0), length * btVector3(std::sin(angle), -std::cos(angle), 0), links);
  const std::vector<btRigidBody*> chain = AddStrand(draft, strand, line);
  const btVector3 end = line.back(), way = (end - line.front()).normalized();
  btRigidBody* const ball = draft->Sphere(radius, DrawLoad(draft, strand.mass), end + radius * way);
  Pin(draft, chain.back(), ball, end);
}

void DrawGarland(Draft* draft) {
  draft->Ground();
  const int links = draft->Count(5, 30);
  const btScalar span = btScalar(links) * draft->Draw(0.25, 0.6);
  Strand strand = DrawLinks(draft, span / btScalar(links));
  strand.last_static = true;
  const btScalar sag = span * draft->Draw(0.03, 0.4), drop = draft->Draw(-0.1, 0.1) * span;
  const btScalar radius = draft->Draw(0.1, 0.3);
  const btScalar height = sag + std::abs(drop) + 4 * radius + btScalar(0.5);
  const std::vector<btVector3> line =
      Sagging(btVector3(-span / 2, height, 0), btVector3(span / 2, height + drop, 0), sag, links);
  const std::vector<btRigidBody*> chain = AddStrand(draft, strand, line);
  const int every = 2 + draft->Choose(6);
  for (int i = every; i < links - 1; i += every) {
    const btVector3 from = chain[i]->getCenterOfMassPosition() -
                           btVector3(0, strand.half_thickness + strand.half_width, 0);
    btRigidBody* const load =
        draft->Sphere(radius, DrawLoad(draft, strand.mass), from - btVector3(0, radius, 0));
    Pin(draft, chain[i], load, from);
  }
}

}  // namespace cairn::bench
