// SPDX-License-Identifier: MIT
#include "worlds/draft.h"

#include <algorithm>
#include <cmath>

#include "scenes/facts.h"

namespace cairn::bench {
namespace {

/// Any of them, the same with every solver as long as they have had the same bodies.
template <class T>
T* Pick(std::span<T* const> things, std::uint64_t which) {
  return things.empty() ? nullptr : things[which % things.size()];
}

void RemoveJoint(World* world, std::uint64_t which) {
  if (btTypedConstraint* joint = Pick(world->joints(), which)) world->Remove(joint);
}

void RemoveBody(World* world, std::uint64_t which) {
  if (world->dynamic_bodies().size() < 2) return;
  world->Remove(Pick(world->dynamic_bodies(), which));
}

/// Pins a body to the one nearest to it.
void PinNeighbours(World* world, std::uint64_t which) {
  btRigidBody* const a = Pick(world->dynamic_bodies(), which);
  btRigidBody* b = nullptr;
  btScalar nearest = btScalar(1.5);  // [m]
  for (btRigidBody* other : world->dynamic_bodies()) {
    const btScalar far = a->getCenterOfMassPosition().distance(other->getCenterOfMassPosition());
    if (other == a || !(far < nearest)) continue;
    b = other;
    nearest = far;
  }
  if (b == nullptr) return;
  const btVector3 middle = (a->getCenterOfMassPosition() + b->getCenterOfMassPosition()) / 2;
  world->AddJoint(std::make_unique<btPoint2PointConstraint>(
                      *a, *b, a->getCenterOfMassTransform().inverse() * middle,
                      b->getCenterOfMassTransform().inverse() * middle),
                  ConnectedBodies::kPassThrough);
}

void Kick(World* world, std::uint64_t which) {
  Random random(which);
  for (btRigidBody* body : world->dynamic_bodies()) {
    body->setLinearVelocity(body->getLinearVelocity() + random.InCube(2));
  }
}

/// Turned by up to 45 degrees.
void TurnGravity(World* world, std::uint64_t which) {
  Random random(which);
  const btVector3 aside = random.InCube(7);
  world->bullet()->setGravity(btVector3(aside.x(), btScalar(-9.81), aside.z()));
}

}  // namespace

void DrawEvents(Draft* draft) {
  using Action = void (*)(World*, std::uint64_t);
  constexpr Action kActions[] = {&RemoveJoint, &RemoveBody, &PinNeighbours, &Kick, &TurnGravity};
  const int count = 1 + draft->Choose(4);
  const Surface surface = draft->rules()->surface;
  const btScalar mass = draft->world()->dynamic_bodies().front()->getMass();
  for (int i = 0; i < count; ++i) {
    const double time = draft->Draw(0.3, 3);
    const std::uint64_t which = draft->random()->Bits();
    const int action = draft->Choose(6);
    if (action < 5) {
      draft->At(time, [act = kActions[action], which](World* world) { act(world, which); });
      continue;
    }
    const btScalar weight = mass * draft->DrawRatio(0.3, 50), radius = draft->Draw(0.1, 0.4);
    draft->At(time, [=](World* world) {
      const btScalar y = btScalar(TopHeight(*world)) + 1 + radius;
      const btRigidBody* const below = Pick(world->dynamic_bodies(), which);
      const btVector3 at = below->getCenterOfMassPosition();
      world->AddSphere(radius, {.mass = weight, .pose = At(at.x(), y, at.z()), .surface = surface});
    });
  }
}

}  // namespace cairn::bench
