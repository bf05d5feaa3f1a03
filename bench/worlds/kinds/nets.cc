// SPDX-License-Identifier: MIT
// Nets of knots on pins.
#include <algorithm>

#include "worlds/kinds/parts.h"

namespace cairn::bench {
namespace {

struct Mesh {
  int columns, rows;
  btScalar pitch, mass;  ///< [m], [kg] of a knot
};

Mesh DrawMesh(Draft* draft) {
  Mesh mesh;
  mesh.columns = draft->Count(3, 8);
  mesh.rows = draft->Count(3, 8);
  mesh.pitch = draft->Draw(0.25, 0.6);
  mesh.mass = draft->DrawRatio(0.1, 3);
  return mesh;
}

/// Knots at origin + column x + row y, those that are `held` static, pinned to their neighbours.
template <class IsHeld>
void AddKnots(Draft* draft, const Mesh& mesh, const btTransform& frame, IsHeld held) {
  const btScalar half = mesh.pitch * btScalar(0.3);
  const bool round = draft->Chance(0.5);
  std::vector<btRigidBody*> knots;
  for (int r = 0; r < mesh.rows; ++r) {
    for (int c = 0; c < mesh.columns; ++c) {
      const btScalar mass = held(c, r) ? 0 : mesh.mass;
      const btTransform pose = frame * At(mesh.pitch * btScalar(c), mesh.pitch * btScalar(r), 0);
      knots.push_back(round ? draft->Sphere(half, mass, pose.getOrigin())
                            : draft->Box(btVector3(half, half, half / 3), mass, pose));
      const auto pin = [&](int other) {
        btRigidBody *const a = knots[other], *const b = knots.back();
        if (a->getInvMass() == 0 && b->getInvMass() == 0) return;
        Pin(draft, a, b, (a->getCenterOfMassPosition() + b->getCenterOfMassPosition()) / 2);
      };
      if (c > 0) pin(r * mesh.columns + c - 1);
      if (r > 0) pin((r - 1) * mesh.columns + c);
    }
  }
}

}  // namespace

void DrawNet(Draft* draft) {
  draft->Ground();
  const Mesh mesh = DrawMesh(draft);
  const btScalar height = mesh.pitch * btScalar(std::max(mesh.columns, mesh.rows));
  const btVector3 corner(0, height, 0);
  const btTransform frame(btQuaternion(btVector3(1, 0, 0), SIMD_HALF_PI), corner);
  AddKnots(draft, mesh, frame, [&](int c, int r) {
    return (c == 0 || c == mesh.columns - 1) && (r == 0 || r == mesh.rows - 1);
  });
  const int things = draft->Count(1, 5);
  const btScalar mass = mesh.mass * draft->DrawRatio(0.3, 200), radius = draft->Draw(0.3, 0.6);
  const btVector3 middle =
      frame * (mesh.pitch / 2 * btVector3(btScalar(mesh.columns - 1), btScalar(mesh.rows - 1), 0));
  for (int i = 0; i < things; ++i) {
    draft->Thing(radius, mass, middle + btVector3(0, radius * btScalar(2.2 * i + 1.5), 0));
  }
}

void DrawCurtain(Draft* draft) {
  draft->Ground();
  const Mesh mesh = DrawMesh(draft);
  const btScalar height = mesh.pitch * btScalar(mesh.rows);
  AddKnots(draft, mesh, At(0, mesh.pitch, 0), [&](int, int r) { return r == mesh.rows - 1; });
  const btScalar radius = draft->Draw(0.2, 0.4);
  btRigidBody* const ball =
      draft->Sphere(radius, mesh.mass * draft->DrawRatio(0.3, 200),
                    btVector3(mesh.pitch * btScalar(mesh.columns) / 2, height / 2 + radius, 3));
  ball->setLinearVelocity(btVector3(0, 0, -draft->Draw(3, 12)));
}

}  // namespace cairn::bench
