// SPDX-License-Identifier: MIT
#include "tests/bullet_adapter/mt/pile.h"

#include <cstring>

namespace cairn::test {

Pile::Pile(btDiscreteDynamicsWorld* world, int side) : world_(*world) {
  constexpr int kLayers = 6;
  world_.setGravity(btVector3(0, btScalar(-9.81), 0));
  const btQuaternion none = btQuaternion::getIdentity();
  bar_.addChildShape(btTransform(none, btVector3(btScalar(-0.5), 0, 0)), &box_);
  bar_.addChildShape(btTransform(none, btVector3(btScalar(0.5), 0, 0)), &box_);
  Add(0, &ground_, btVector3(0, 0, 0));
  moving_floor_ = Add(0, &floor_, btVector3(-8, 1, 0));
  moving_floor_->setCollisionFlags(moving_floor_->getCollisionFlags() |
                                   btCollisionObject::CF_KINEMATIC_OBJECT);
  moving_floor_->setActivationState(DISABLE_DEACTIVATION);
  for (int layer = 0; layer < kLayers; ++layer) AddLayer(layer, side);
  for (int i = 0; i < 4; ++i) AddChain(btVector3(btScalar(2 * i), 12, -6));
  for (int i = 0; i < 5; ++i) {
    uneven_ = Add(1, &box_, btVector3(-8, btScalar(1.7) + btScalar(1.02) * btScalar(i), 0));
  }
}

Pile::~Pile() {
  for (const auto& joint : joints_) world_.removeConstraint(joint.get());
  for (const auto& body : bodies_) world_.removeRigidBody(body.get());
}

btRigidBody* Pile::Add(btScalar mass, btCollisionShape* shape, const btVector3& at) {
  btVector3 inertia(0, 0, 0);
  if (mass > 0) shape->calculateLocalInertia(mass, inertia);
  bodies_.push_back(std::make_unique<btRigidBody>(mass, nullptr, shape, inertia));
  btRigidBody* const body = bodies_.back().get();
  body->setWorldTransform(btTransform(btQuaternion::getIdentity(), at));
  if (shape == &ball_) {
    body->setCcdMotionThreshold(btScalar(0.05));
    body->setCcdSweptSphereRadius(btScalar(0.2));
    body->setLinearVelocity(btVector3(0, -20, 1));
    body->setRollingFriction(btScalar(0.05));
    body->setSpinningFriction(btScalar(0.02));
  }
  world_.addRigidBody(body);
  return body;
}

void Pile::AddLayer(int layer, int side) {
  btCollisionShape* const shapes[] = {&box_, &bar_, &box_, &ball_};
  for (int i = 0; i < side * side; ++i) {
    const btVector3 at(btScalar(2.2) * btScalar(i % side) + btScalar(0.07) * btScalar(layer),
                       1 + btScalar(1.4) * btScalar(layer),
                       btScalar(1.3) * btScalar(i / side) + btScalar(0.05) * btScalar(i % 5));
    Add(btScalar(1 + i % 3), shapes[(i + layer) % 4], at);
  }
}

void Pile::AddChain(const btVector3& at) {
  btRigidBody* above = nullptr;
  for (int i = 0; i < 6; ++i) {
    btRigidBody* const link = Add(1, &ball_, at - btVector3(0, btScalar(0.8) * btScalar(i), 0));
    const btVector3 up(0, btScalar(0.4), 0);
    if (above == nullptr) {
      joints_.push_back(std::make_unique<btPoint2PointConstraint>(*link, up));
    } else {
      joints_.push_back(std::make_unique<btPoint2PointConstraint>(*above, *link, -up, up));
    }
    world_.addConstraint(joints_.back().get(), true);
    above = link;
  }
}

void Pile::Step(int frames) {
  for (int i = 0; i < frames; ++i, ++frame_) {
    btTransform pose = moving_floor_->getWorldTransform();
    pose.getOrigin().setX(-8 + btScalar(0.01) * btScalar(frame_ % 100));
    moving_floor_->setWorldTransform(pose);
    const bool uneven = frame_ >= 60 && frame_ < 120;
    uneven_->setAnisotropicFriction(uneven ? btVector3(1, btScalar(0.5), 1) : btVector3(1, 1, 1));
    world_.stepSimulation(btScalar(1) / 60, 0, btScalar(1) / 60);
  }
}

std::uint64_t Pile::Hash() const {
  std::uint64_t hash = 14695981039346656037u;
  const auto add = [&hash](const btVector3& vector) {
    for (int k = 0; k < 3; ++k) {
      unsigned char bytes[sizeof(btScalar)];
      std::memcpy(bytes, &vector[k], sizeof(btScalar));
      for (const unsigned char byte : bytes) hash = (hash ^ byte) * 1099511628211u;
    }
  };
  for (const auto& body : bodies_) {
    const btTransform& pose = body->getWorldTransform();
    add(pose.getOrigin());
    for (int k = 0; k < 3; ++k) add(pose.getBasis()[k]);
    add(body->getLinearVelocity());
    add(body->getAngularVelocity());
  }
  return hash;
}

}  // namespace cairn::test
