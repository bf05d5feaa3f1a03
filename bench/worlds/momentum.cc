// SPDX-License-Identifier: MIT
#include "worlds/momentum.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "scenes/facts.h"

namespace cairn::bench {
namespace {

using Eigen::Vector3d;

Vector3d ToVector(const btVector3& v) { return {double(v.x()), double(v.y()), double(v.z())}; }

Eigen::Matrix3d InertiaOf(const btRigidBody& body) {
  const btMatrix3x3 inertia = body.getInvInertiaTensorWorld().inverse();
  Eigen::Matrix3d result;
  for (int i = 0; i < 3; ++i) result.row(i) = ToVector(inertia[i]);
  return result;
}

}  // namespace

void MomentumWatch::Listen(World* world) {
  for (btTypedConstraint* joint : world->joints()) {
    joint->setJointFeedback(&feedback_.emplace_back());
  }
}

void MomentumWatch::Begin(const World& world) {
  const double gap = LargestJointGap(world);
  gap_ = gap > 0 ? gap : 0;
  places_.clear();
  middle_.setZero();
  mass_ = 0;
  for (const btRigidBody* body : world.dynamic_bodies()) {
    places_.push_back(
        {ToVector(body->getCenterOfMassPosition()), InertiaOf(*body), double(body->getMass())});
    mass_ += places_.back().mass;
    middle_ += places_.back().mass * places_.back().position;
  }
  middle_ /= mass_;
  before_ = Sum(world);
}

MomentumWatch::Momenta MomentumWatch::Sum(const World& world) {
  Momenta sum{Vector3d::Zero(), Vector3d::Zero()};
  double linear_size = 0, angular_size = 0;
  for (size_t i = 0; i < places_.size(); ++i) {
    const btRigidBody& body = *world.dynamic_bodies()[i];
    const Vector3d linear = places_[i].mass * ToVector(body.getLinearVelocity());
    const Vector3d orbit = (places_[i].position - middle_).cross(linear);
    const Vector3d spin = places_[i].inertia * ToVector(body.getAngularVelocity());
    sum.linear += linear;
    sum.angular += orbit + spin;
    linear_size += linear.norm();
    angular_size += orbit.norm() + spin.norm();
  }
  linear_size_ = std::max(linear_size_, linear_size);
  angular_size_ = std::max(angular_size_, angular_size);
  return sum;
}

void MomentumWatch::End(const World& world, double time_step) {
  const Momenta now = Sum(world);
  const Vector3d gravity = ToVector(world.bullet()->getGravity());
  linear_drift_ += now.linear - before_.linear - mass_ * time_step * gravity;
  angular_drift_ += now.angular - before_.angular;
  linear_ = std::max(linear_, linear_drift_.norm());
  for (const btJointFeedback& joint : feedback_) {
    owed_by_rows_ += gap_ * time_step * double(joint.m_appliedForceBodyA.length());
  }
  owed_by_rows_ += FrictionTwist(world);
  angular_ = std::max(angular_, angular_drift_.norm() - owed_by_rows_);
}

}  // namespace cairn::bench
