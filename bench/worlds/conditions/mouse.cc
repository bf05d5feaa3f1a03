// SPDX-License-Identifier: MIT
#include "worlds/conditions/mouse.h"

namespace cairn::bench {
namespace {

constexpr double kHoldsPerSecond = 2, kTurnsPerSecond = 4;
constexpr double kShortest = 0.1, kLongest = 1.5;  // [s]
constexpr double kSlow = 2, kFast = 10;            // [m/s]

}  // namespace

Mouse::~Mouse() { LetGo(); }

void Mouse::Act(double time_step, World* world) {
  world_ = world;
  // an event may have taken the body out of the world
  if (joint_ != nullptr && !joint_->getRigidBodyA().isInWorld()) LetGo();
  if (joint_ != nullptr) {
    Drag(time_step);
  } else if (random_.Within(0, 1) < kHoldsPerSecond * time_step) {
    Take(world);
  }
}

void Mouse::Take(World* world) {
  const auto bodies = world->dynamic_bodies();
  const std::uint64_t which = random_.Bits();
  if (bodies.empty()) return;
  btRigidBody* const body = bodies[which % bodies.size()];
  btVector3 low, high;
  body->getCollisionShape()->getAabb(btTransform::getIdentity(), low, high);
  const btVector3 at = (low + high) / 2 + random_.InCube(0.5) * (high - low);
  joint_ = std::make_unique<btPoint2PointConstraint>(*body, at);
  const double strength = random_.Within(0, 1);
  if (strength < 0.4) {
    // of the demos
    joint_->m_setting.m_impulseClamp = 30;
    joint_->m_setting.m_tau = btScalar(0.001);
  } else if (strength < 0.6) {
    joint_->m_setting.m_impulseClamp = 3 * body->getMass();
  }
  world->bullet()->addConstraint(joint_.get());
  velocity_ = random_.InCube(random_.Within(0, 1) < 0.5 ? kSlow : kFast);
  left_ = random_.Within(kShortest, kLongest);
  body->activate(true);
}

void Mouse::Drag(double time_step) {
  left_ -= time_step;
  if (left_ < 0) return LetGo();
  if (random_.Within(0, 1) < kTurnsPerSecond * time_step) {
    velocity_ = random_.InCube(random_.Within(0, 1) < 0.5 ? kSlow : kFast);
  }
  joint_->setPivotB(joint_->getPivotInB() + velocity_ * static_cast<btScalar>(time_step));
  joint_->getRigidBodyA().activate(true);
}

void Mouse::LetGo() {
  if (joint_ == nullptr) return;
  world_->bullet()->removeConstraint(joint_.get());
  joint_.reset();
}

}  // namespace cairn::bench
