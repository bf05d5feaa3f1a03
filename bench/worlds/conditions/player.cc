// SPDX-License-Identifier: MIT
#include "worlds/conditions/player.h"

#include <cmath>

namespace cairn::bench {
namespace {

constexpr double kActionsPerSecond = 8;

void Throw(Random* random, btRigidBody* body) { body->setLinearVelocity(random->InCube(5)); }

void Spin(Random* random, btRigidBody* body) { body->setAngularVelocity(random->InCube(10)); }

void Move(Random* random, btRigidBody* body) {
  btTransform pose = body->getWorldTransform();
  pose.setOrigin(pose.getOrigin() + random->InCube(0.5));
  body->setWorldTransform(pose);
  body->setInterpolationWorldTransform(pose);
}

/// At a point of the box around its shape.
void Push(Random* random, btRigidBody* body) {
  btVector3 low, high;
  body->getCollisionShape()->getAabb(btTransform::getIdentity(), low, high);
  const btVector3 impulse = random->InCube(5) * body->getMass();
  const btVector3 at = (low + high) / 2 + random->InCube(0.5) * (high - low);
  body->applyImpulse(impulse, body->getWorldTransform().getBasis() * at);
}

void Weigh(Random* random, btRigidBody* body) {
  const auto ratio = static_cast<btScalar>(std::pow(4, random->Within(-1, 1)));
  const btVector3 gravity = body->getGravity();
  body->setMassProps(ratio * body->getMass(), ratio * body->getLocalInertia());
  body->updateInertiaTensor();
  body->setGravity(gravity);
}

}  // namespace

void Player::Act(double time_step, World* world) {
  using Action = void (*)(Random*, btRigidBody*);
  constexpr Action kActions[] = {&Throw, &Spin, &Move, &Push, &Weigh};
  if (random_.Within(0, 1) >= kActionsPerSecond * time_step) return;
  const auto bodies = world->dynamic_bodies();
  const std::uint64_t which = random_.Bits(), what = random_.Bits();
  if (bodies.empty()) return;
  btRigidBody* const body = bodies[which % bodies.size()];
  body->activate(true);
  kActions[what % std::size(kActions)](&random_, body);
}

}  // namespace cairn::bench
