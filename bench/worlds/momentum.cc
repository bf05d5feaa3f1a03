// SPDX-License-Identifier: MIT
#include "worlds/momentum.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace cairn::bench {
namespace {

using Eigen::Vector3d;

Vector3d ToVector(const btVector3& v) { return {double(v.x()), double(v.y()), double(v.z())}; }

struct Momenta {
  Vector3d linear = Vector3d::Zero(), angular = Vector3d::Zero();
  double mass = 0, linear_size = 0, angular_size = 0;
};

Momenta Sum(const World& world) {
  Momenta sum;
  Vector3d middle = Vector3d::Zero();
  for (const btRigidBody* body : world.dynamic_bodies()) {
    const double mass = body->getMass();
    sum.mass += mass;
    middle += mass * ToVector(body->getCenterOfMassPosition());
    sum.linear += mass * ToVector(body->getLinearVelocity());
    sum.linear_size += mass * double(body->getLinearVelocity().length());
  }
  middle /= sum.mass;
  const Vector3d drift = sum.linear / sum.mass;
  for (const btRigidBody* body : world.dynamic_bodies()) {
    const Vector3d arm = ToVector(body->getCenterOfMassPosition()) - middle;
    const Vector3d speed = ToVector(body->getLinearVelocity()) - drift;
    const btVector3 turning =
        body->getInvInertiaTensorWorld().inverse() * body->getAngularVelocity();
    sum.angular += body->getMass() * arm.cross(speed) + ToVector(turning);
    sum.angular_size += body->getMass() * arm.norm() * speed.norm() + double(turning.length());
  }
  return sum;
}

}  // namespace

MomentumWatch::MomentumWatch(const World& world) {
  const Momenta now = Sum(world);
  for (int i = 0; i < 3; ++i) {
    start_[i] = now.linear[i];
    start_[3 + i] = now.angular[i];
  }
  linear_size_ = std::max(linear_size_, now.linear_size);
  angular_size_ = std::max(angular_size_, now.angular_size);
}

void MomentumWatch::Look(const World& world, double time) {
  const Momenta now = Sum(world);
  const Vector3d gravity = ToVector(world.bullet()->getGravity());
  const Vector3d linear = Vector3d(start_) + now.mass * time * gravity, angular(start_ + 3);
  linear_ = std::max(linear_, (now.linear - linear).norm());
  angular_ = std::max(angular_, (now.angular - angular).norm());
  linear_size_ = std::max(linear_size_, now.linear_size);
  angular_size_ = std::max(angular_size_, now.angular_size);
}

}  // namespace cairn::bench
