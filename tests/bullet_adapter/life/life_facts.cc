// SPDX-License-Identifier: MIT
// What a Life looks at after every frame.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "tests/bullet_adapter/life/life.h"

namespace cairn::test {
namespace {

/// FNV-1a over the bytes of a number.
void Fold(btScalar value, std::uint64_t* hash) {
  unsigned char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  for (const unsigned char byte : bytes) *hash = (*hash ^ byte) * 0x100000001b3u;
}

void Fold(const btVector3& value, std::uint64_t* hash) {
  for (int k = 0; k < 3; ++k) Fold(value[k], hash);
}

double KineticEnergy(const btRigidBody& body) {
  const btVector3 &spin = body.getAngularVelocity(), inertia = body.getLocalInertia();
  const btVector3 local = spin * body.getWorldTransform().getBasis();
  return 0.5 * body.getMass() * body.getLinearVelocity().length2() +
         0.5 * (local * local).dot(inertia);
}

}  // namespace

bool Life::Finite(const btVector3& value) {
  const bool finite =
      std::isfinite(value.x()) && std::isfinite(value.y()) && std::isfinite(value.z());
  finite_ = finite_ && finite;
  return finite;
}

void Life::ObserveBodies() {
  double energy = 0, mass = 0;
  int sleepers = 0;
  for (const auto& piece : pieces_) {
    const btRigidBody& body = *piece->body;
    const btTransform& pose = body.getWorldTransform();
    const btVector3 &velocity = body.getLinearVelocity(), &spin = body.getAngularVelocity();
    for (int k = 0; k < 3; ++k) {
      Finite(pose.getBasis()[k]);
      Fold(pose.getBasis()[k], &hash_);
    }
    for (const btVector3& value : {pose.getOrigin(), velocity, spin}) {
      Finite(value);
      Fold(value, &hash_);
    }
    facts_.depth = std::max<double>(facts_.depth, -pose.getOrigin().y());
    if (!body.isActive()) ++sleepers;
    if (body.isStaticOrKinematicObject()) continue;
    facts_.speed = std::max<double>(facts_.speed, velocity.length());
    facts_.spin = std::max<double>(facts_.spin, spin.length());
    energy += KineticEnergy(body);
    mass += body.getMass();
  }
  facts_.sleepers = std::max(facts_.sleepers, sleepers);
  if (mass > 0) facts_.energy = std::max(facts_.energy, energy / mass);
}

void Life::ObserveLinks() {
  for (Link& link : links_) {
    const btScalar impulse = link.joint->internalGetAppliedImpulse();
    finite_ = finite_ && std::isfinite(impulse);
    Fold(impulse, &hash_);
    const bool enabled = link.joint->isEnabled();
    if (link.was_enabled && !enabled) ++facts_.joints_broken;
    link.was_enabled = enabled;
    if (link.feedback == nullptr) continue;
    for (const btVector3& value :
         {link.feedback->m_appliedForceBodyA, link.feedback->m_appliedTorqueBodyA,
          link.feedback->m_appliedForceBodyB, link.feedback->m_appliedTorqueBodyB}) {
      Finite(value);
      Fold(value, &hash_);
    }
  }
}

void Life::Observe() {
  finite_ = true;
  ObserveBodies();
  ObserveLinks();
  if (!finite_) ++facts_.not_finite;
  const bool expected = solver_->foreign && solver_->options().mode == bullet::Mode::kFast;
  if (solver_->foreign) ++facts_.foreign_frames;
  if (solver_->fell_back() != expected) ++facts_.refusals;
}

}  // namespace cairn::test
