// SPDX-License-Identifier: MIT
#include "worlds/conditions/moving_ground.h"

#include <cmath>

namespace cairn::bench {
namespace {

constexpr double kSlowest = 1, kFastest = 4;  // [rad/s]

}  // namespace

MovingGround::MovingGround(Random random, World* world) {
  constexpr btScalar kRoll = btScalar(0.3);
  const bool together = random.Within(0, 1) < 0.5;
  const btVector3 reach = random.InCube(0.5);
  const double pace = random.Within(kSlowest, kFastest);
  const btCollisionObjectArray& objects = world->bullet()->getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) {
    btRigidBody* const body = btRigidBody::upcast(objects[i]);
    if (body == nullptr || !body->isStaticObject()) continue;
    MakeKinematic(body);
    const btTransform& pose = body->getWorldTransform();
    if (together) {
      movers_.push_back({body, pose, reach, kRoll, pace});
    } else {
      const btVector3 own = random.InCube(0.2);
      movers_.push_back({body, pose, own, 0, random.Within(kSlowest, kFastest)});
    }
  }
}

void MovingGround::MoveTo(double time) {
  for (const Mover& mover : movers_) {
    const auto share = static_cast<btScalar>(std::sin(mover.pace * time));
    const btVector3 axis = mover.reach.fuzzyZero() ? btVector3(1, 0, 0) : mover.reach.normalized();
    const btTransform roll(btQuaternion(axis, mover.turn * share), mover.reach * share);
    mover.body->setWorldTransform(roll * mover.pose);
  }
}

}  // namespace cairn::bench
