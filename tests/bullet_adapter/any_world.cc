// SPDX-License-Identifier: MIT
#include "tests/bullet_adapter/any_world.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace cairn::test {
namespace {

btTransform At(btScalar x, btScalar y, btScalar z) {
  return btTransform(btQuaternion::getIdentity(), btVector3(x, y, z));
}

/// FNV-1a over the bytes of three numbers.
void Fold(const btVector3& value, std::uint64_t* hash) {
  unsigned char bytes[3 * sizeof(btScalar)];
  std::memcpy(bytes, value.m_floats, sizeof bytes);
  for (const unsigned char byte : bytes) *hash = (*hash ^ byte) * 0x100000001b3u;
}

}  // namespace

AnyWorld::AnyWorld(std::unique_ptr<btCollisionConfiguration> configuration,
                   std::unique_ptr<btCollisionDispatcher> dispatcher, const Make& make)
    : configuration_(std::move(configuration)), dispatcher_(std::move(dispatcher)) {
  world_ = make({dispatcher_.get(), &broadphase_, configuration_.get()});
  world_->setGravity({0, btScalar(-9.81), 0});
}

AnyWorld::~AnyWorld() {
  for (const auto& joint : joints_) world_->removeConstraint(joint.get());
  for (btRigidBody* body : pointers_) world_->removeRigidBody(body);
}

btRigidBody* AnyWorld::AddBox(const btVector3& half_extents, btScalar mass,
                              const btTransform& pose) {
  shapes_.push_back(std::make_unique<btBoxShape>(half_extents));
  btVector3 inertia(0, 0, 0);
  if (mass > 0) shapes_.back()->calculateLocalInertia(mass, inertia);
  btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shapes_.back().get(), inertia);
  info.m_startWorldTransform = pose;
  bodies_.push_back(std::make_unique<btRigidBody>(info));
  pointers_.push_back(bodies_.back().get());
  world_->addRigidBody(pointers_.back());
  return pointers_.back();
}

void AnyWorld::AddGround() { AddBox({60, 1, 60}, 0, At(0, -1, 0)); }

void AnyWorld::AddTower(int height, btScalar x, btScalar z) {
  for (int i = 0; i < height; ++i) {
    const btScalar y = btScalar(0.51) + btScalar(1.01) * btScalar(i);
    AddBox({btScalar(0.5), btScalar(0.5), btScalar(0.5)}, 1, At(x, y, z));
  }
}

void AnyWorld::AddChain(int length, btScalar x, btScalar z) {
  const btVector3 up(0, btScalar(0.3), 0);
  btRigidBody* above = nullptr;
  for (int i = 0; i < length; ++i) {
    btRigidBody* const box = AddBox({btScalar(0.1), btScalar(0.2), btScalar(0.1)}, 1,
                                    At(x, 9 - btScalar(0.6) * btScalar(i), z));
    box->setLinearVelocity({btScalar(0.5), 0, 0});
    AddJoint(above == nullptr ? std::make_unique<btPoint2PointConstraint>(*box, up)
                              : std::make_unique<btPoint2PointConstraint>(*above, *box, -up, up));
    above = box;
  }
}

void AnyWorld::AddJoint(std::unique_ptr<btTypedConstraint> joint, bool collide) {
  world_->addConstraint(joint.get(), !collide);
  joints_.push_back(std::move(joint));
}

void AnyWorld::Step(int frames) {
  for (int i = 0; i < frames; ++i) world_->stepSimulation(btScalar(1) / 60, 0);
}

std::uint64_t AnyWorld::Hash() const {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const btRigidBody* body : pointers_) {
    const btTransform& pose = body->getWorldTransform();
    for (int k = 0; k < 3; ++k) Fold(pose.getBasis()[k], &hash);
    Fold(pose.getOrigin(), &hash);
    Fold(body->getLinearVelocity(), &hash);
    Fold(body->getAngularVelocity(), &hash);
  }
  return hash;
}

double AnyWorld::LargestSpeed() const {
  double largest = 0;
  for (const btRigidBody* body : pointers_) {
    if (body->isStaticOrKinematicObject()) continue;
    largest = std::max<double>(largest, body->getLinearVelocity().length());
  }
  return largest;
}

std::unique_ptr<AnyWorld> DiscreteWorld(btConstraintSolver* solver) {
  auto configuration = std::make_unique<btDefaultCollisionConfiguration>();
  auto dispatcher = std::make_unique<btCollisionDispatcher>(configuration.get());
  return std::make_unique<AnyWorld>(
      std::move(configuration), std::move(dispatcher), [solver](const AnyWorld::Parts& parts) {
        return std::make_unique<btDiscreteDynamicsWorld>(parts.dispatcher, parts.broadphase, solver,
                                                         parts.configuration);
      });
}

}  // namespace cairn::test
