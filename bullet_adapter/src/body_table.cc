// SPDX-License-Identifier: MIT
#include "body_table.h"

#include <algorithm>
#include <cstdint>

#include "conversions.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

/// What forces add to the velocity over a step.
Motion MotionOf(const btRigidBody& rigid, btScalar time_step) {
  Motion motion{rigid.getLinearVelocity(), rigid.getAngularVelocity(), {0, 0, 0}, {0, 0, 0}};
  if (!Reacts(rigid)) return motion;
  motion.external_velocity = rigid.getTotalForce() * rigid.getInvMass() * time_step;
  motion.external_spin = rigid.getTotalTorque() * rigid.getInvInertiaTensorWorld() * time_step;
  return motion;
}

/// The change of spin by gyroscopic terms over a step, in each of the modes that a body asks for.
btVector3 GyroscopicSpin(const btRigidBody& rigid, const btContactSolverInfo& info) {
  btVector3 spin(0, 0, 0);
  const int flags = rigid.getFlags();
  if ((flags & BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT) != 0) {
    spin -= rigid.computeGyroscopicForceExplicit(info.m_maxGyroscopicForce) *
            rigid.getInvInertiaTensorWorld() * info.m_timeStep;
  }
  if ((flags & BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD) != 0) {
    spin += rigid.computeGyroscopicImpulseImplicit_World(info.m_timeStep);
  }
  if ((flags & BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY) != 0) {
    spin += rigid.computeGyroscopicImpulseImplicit_Body(info.m_timeStep);
  }
  return spin;
}

/// Bodies lie all over the memory; all of one is read.
void PrefetchBehind(std::span<btCollisionObject* const> objects, size_t i) {
  constexpr size_t kAhead = 4;
  if (i + kAhead >= objects.size()) return;
  Prefetch(objects[i + kAhead], sizeof(btRigidBody));
}

}  // namespace

bool Reacts(const btRigidBody& rigid) {
  return rigid.getInvMass() != 0 && !rigid.isStaticOrKinematicObject();
}

Body ToBody(const btRigidBody& rigid) {
  Body body;
  if (!Reacts(rigid)) return body;
  const Eigen::Vector3d angular_factor = ToEigen(rigid.getAngularFactor());
  body.inv_mass = rigid.getInvMass();
  body.linear_factor = ToEigen(rigid.getLinearFactor()).cwiseAbs();
  body.inv_inertia = angular_factor.asDiagonal() * ToEigen(rigid.getInvInertiaTensorWorld()) *
                     angular_factor.asDiagonal();
  body.id = static_cast<std::uint64_t>(std::max(0, rigid.getWorldArrayIndex() + 1));
  return body;
}

void BodyTable::Begin(std::span<btCollisionObject* const> objects,
                      const btContactSolverInfo& info) {
  ++substep_;
  time_step_ = info.m_timeStep;
  strangers_.clear();
  bodies_.clear();
  motions_.clear();
  rigids_.clear();
  for (size_t i = 0; i < objects.size(); ++i) {
    const btCollisionObject* const object = objects[i];
    PrefetchBehind(objects, i);
    const int before = size();
    const Party& party = PartyOf(*object);
    if (party.number < before || !party.reacts) continue;
    motions_[party.number].external_spin += GyroscopicSpin(*rigids_[party.number], info);
  }
}

const Party& BodyTable::Enter(const btCollisionObject& object) {
  const int index = object.getWorldArrayIndex();
  if (index >= static_cast<int>(slots_.size())) slots_.resize(index + 1);
  if (index >= 0 && slots_[index].substep != substep_) {
    Slot& slot = slots_[index];
    slot.object = &object;
    slot.substep = substep_;
    Fill(object, &slot.party);
    return slot.party;
  }
  const auto [entry, is_new] = strangers_.try_emplace(&object);
  if (is_new) Fill(object, &entry->second);
  return entry->second;
}

void BodyTable::Fill(const btCollisionObject& object, Party* party) {
  using Object = btCollisionObject;
  const btVector3& at = object.getWorldTransform().getOrigin();
  for (int k = 0; k < 3; ++k) party->at[k] = at[k];
  party->number = kWorld;
  party->reacts = false;
  party->slides_unevenly = object.hasAnisotropicFriction(Object::CF_ANISOTROPIC_FRICTION);
  party->rolls_unevenly = object.hasAnisotropicFriction(Object::CF_ANISOTROPIC_ROLLING_FRICTION);
  // the solver of a world may write to its bodies, though manifolds hold them as const
  btRigidBody* const rigid = btRigidBody::upcast(const_cast<btCollisionObject*>(&object));
  if (rigid == nullptr) return;
  party->reacts = Reacts(*rigid);
  if (!party->reacts && !rigid->isKinematicObject()) return;
  party->number = size();
  bodies_.push_back(ToBody(*rigid));
  motions_.push_back(MotionOf(*rigid, time_step_));
  rigids_.push_back(rigid);
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
