// SPDX-License-Identifier: MIT
#include "body_table.h"

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <algorithm>
#include <cstdint>

#include "cairn/detail/gyroscopic.h"
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

/// What Bullet adds to the spins of bodies over a step by gyroscopic terms, to the last bit, in
/// each of the modes that a body asks for. The default one, implicit in the frame of the body, is
/// done for many bodies at a time.
class GyroscopicTerms {
 public:
  GyroscopicTerms(const btContactSolverInfo& info, std::vector<Motion>* motions)
      : info_(info), motions_(*motions) {}

  /// Adds those of a body to its motion, at the latest in End().
  void Add(const btRigidBody& rigid, int number) {
    const int flags = rigid.getFlags();
    btVector3& spin = motions_[number].external_spin;
    if ((flags & BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT) != 0) {
      spin -= rigid.computeGyroscopicForceExplicit(info_.m_maxGyroscopicForce) *
              rigid.getInvInertiaTensorWorld() * info_.m_timeStep;
    }
    if ((flags & BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD) != 0) {
      spin += rigid.computeGyroscopicImpulseImplicit_World(info_.m_timeStep);
    }
    if ((flags & BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY) != 0) AddImplicit(rigid, number);
  }

  void End() {
    if (count_ == 0) return;
    FindGyroscopicTerms(info_.m_timeStep, &lanes_);
    for (int l = 0; l < count_; ++l) {
      motions_[number_[l]].external_spin +=
          btVector3(lanes_.change[0][l], lanes_.change[1][l], lanes_.change[2][l]);
    }
    count_ = 0;
  }

 private:
  void AddImplicit(const btRigidBody& rigid, int number) {
    const btQuaternion turn = rigid.getWorldTransform().getRotation();
    for (int k = 0; k < 3; ++k) {
      lanes_.inv_moment[k][count_] = rigid.getInvInertiaDiagLocal()[k];
      lanes_.spin[k][count_] = rigid.getAngularVelocity()[k];
    }
    for (int k = 0; k < 4; ++k) lanes_.turn[k][count_] = turn[k];
    number_[count_++] = number;
    if (count_ == Gyroscopes<btScalar>::kMost) End();
  }

  const btContactSolverInfo& info_;
  std::vector<Motion>& motions_;
  Gyroscopes<btScalar> lanes_;
  int number_[Gyroscopes<btScalar>::kMost];
  int count_ = 0;
};

/// Bodies lie all over the memory; all of one is read.
void PrefetchAhead(std::span<btCollisionObject* const> objects, size_t i) {
  constexpr size_t kAhead = 4;
  if (i + kAhead >= objects.size()) return;
  Prefetch(objects[i + kAhead], sizeof(btRigidBody));
}

}  // namespace

bool Reacts(const btRigidBody& rigid) {
  return rigid.getInvMass() != 0 && !rigid.isStaticOrKinematicObject();
}

btScalar HalfDiagonal(const btRigidBody& rigid, const btVector3& linear, const btVector3& angular) {
  return linear.length2() * rigid.getInvMass() +
         (rigid.getInvInertiaTensorWorld() * angular).dot(angular);
}

Body ToBody(const btRigidBody& rigid) {
  Body body;
  if (!Reacts(rigid)) return body;
  const Eigen::Vector3d angular_factor = ToEigen(rigid.getAngularFactor());
  body.inv_mass = rigid.getInvMass();
  body.linear_factor = ToEigen(rigid.getLinearFactor()).cwiseAbs();
  body.inv_inertia = angular_factor.asDiagonal() * ToEigen(rigid.getInvInertiaTensorWorld()) *
                     angular_factor.asDiagonal();
  return body;
}

void BodyTable::Begin(std::span<btCollisionObject* const> objects, const btContactSolverInfo& info,
                      detail::Threads* threads) {
  ++substep_;
  time_step_ = info.m_timeStep;
  // those of before are found again without an allocation; of most nobody asks again
  constexpr size_t kMostStrangers = 1 << 10;
  if (strangers_.size() > kMostStrangers) strangers_.clear();
  names_.BeginSubstep();
  if (threads->several() && EnterInParts(objects, info, threads)) return;
  EnterInOrder(objects, info);
}

void BodyTable::Forget() {
  names_.Forget();
  slots_.clear();
  ++growths_;
}

void BodyTable::EnterInOrder(std::span<btCollisionObject* const> objects,
                             const btContactSolverInfo& info) {
  bodies_.clear();
  motions_.clear();
  rigids_.clear();
  GyroscopicTerms terms(info, &motions_);
  for (size_t i = 0; i < objects.size(); ++i) {
    const btCollisionObject* const object = objects[i];
    PrefetchAhead(objects, i);
    const int before = size();
    const ContactEnd& end = EndOf(*object);
    if (end.number < before || !end.reacts) continue;
    terms.Add(*rigids_[end.number], end.number);
  }
  terms.End();
}

bool BodyTable::EnterInParts(std::span<btCollisionObject* const> objects,
                             const btContactSolverInfo& info, detail::Threads* threads) {
  constexpr int kObjectsOfPart = 128;
  constexpr SpanLabel kLabel{SpanKind::kRead};
  const int count = static_cast<int>(objects.size());
  if (claims_size_ < slots_.size()) {
    claims_size_ = 2 * slots_.size();
    claims_ = std::make_unique<std::atomic<unsigned>[]>(claims_size_);
  }
  parts_.assign((count + kObjectsOfPart - 1) / kObjectsOfPart, {});
  const auto count_part = [&](int first, int of_part) {
    parts_[first / kObjectsOfPart] = Count(objects.subspan(first, of_part));
  };
  threads->For(count, kObjectsOfPart, count_part, kLabel);
  int bodies = 0;
  for (Part& part : parts_) {
    if (!part.regular) return false;
    part.first = bodies;
    bodies += part.bodies;
  }
  for (size_t i = 0; i < parts_.size(); ++i) {
    if (!parts_[i].renamed) continue;
    const size_t first = i * kObjectsOfPart;
    EnterNames(objects.subspan(first, std::min<size_t>(kObjectsOfPart, objects.size() - first)));
  }
  bodies_.resize(bodies);
  motions_.resize(bodies);
  rigids_.resize(bodies);
  const auto enter_part = [&](int first, int of_part) {
    EnterPart(objects.subspan(first, of_part), parts_[first / kObjectsOfPart].first, info);
  };
  threads->For(count, kObjectsOfPart, enter_part, kLabel);
  return true;
}

BodyTable::Part BodyTable::Count(std::span<btCollisionObject* const> objects) {
  Part part;
  for (size_t i = 0; i < objects.size(); ++i) {
    PrefetchAhead(objects, i);
    const int index = objects[i]->getWorldArrayIndex();
    part.regular = index >= 0 && index < static_cast<int>(slots_.size()) &&
                   claims_[index].exchange(substep_, std::memory_order_relaxed) != substep_;
    if (!part.regular) return part;
    ContactEnd end;
    const btRigidBody* const rigid = Describe(*objects[i], &end);
    if (rigid == nullptr) continue;
    ++part.bodies;
    part.renamed |= end.reacts && !names_.Knows(index, *rigid);
  }
  return part;
}

void BodyTable::EnterNames(std::span<btCollisionObject* const> objects) {
  for (const btCollisionObject* const object : objects) {
    const btRigidBody* const rigid = btRigidBody::upcast(object);
    if (rigid != nullptr && Reacts(*rigid)) NameOf(*rigid);
  }
}

std::uint64_t BodyTable::NameOf(const btRigidBody& rigid) {
  const int place = rigid.getWorldArrayIndex();
  if (!names_.Knows(place, rigid)) names_.Enter(place, rigid);
  return names_.of(place);
}

void BodyTable::EnterPart(std::span<btCollisionObject* const> objects, int first,
                          const btContactSolverInfo& info) {
  GyroscopicTerms terms(info, &motions_);
  int number = first;
  for (size_t i = 0; i < objects.size(); ++i) {
    PrefetchAhead(objects, i);
    const btCollisionObject& object = *objects[i];
    const int index = object.getWorldArrayIndex();
    Slot& slot = slots_[index];
    slot.object = &object;
    slot.substep = substep_;
    btRigidBody* const rigid = Describe(object, &slot.end);
    if (rigid == nullptr) continue;
    slot.end.number = number;
    bodies_[number] = ToBody(*rigid);
    if (slot.end.reacts) bodies_[number].id = names_.of(index);
    motions_[number] = MotionOf(*rigid, time_step_);
    rigids_[number] = rigid;
    if (slot.end.reacts) terms.Add(*rigid, number);
    ++number;
  }
  terms.End();
}

void BodyTable::FindJointed(std::span<btTypedConstraint* const> joints) {
  // bodies know only of joints that keep them from colliding
  jointed_.assign(rigids_.size(), 0);
  const auto mark = [this](const btRigidBody& rigid) {
    const ContactEnd* const end = Find(rigid);
    if (end != nullptr && end->number != kWorld) jointed_[end->number] = 1;
  };
  for (const btTypedConstraint* const joint : joints) {
    if (!joint->isEnabled()) continue;
    mark(joint->getRigidBodyA());
    mark(joint->getRigidBodyB());
  }
}

void BodyTable::Stiffen(std::span<btTypedConstraint* const> joints, btScalar part,
                        GeometricStiffness* stiffness) {
  if (stiffness->empty()) return;  // nothing is strained, and ToBody() says so
  FindJointed(joints);
  for (const GeometricStiffness::Raised& raised :
       stiffness->RaiseInertia(part, bodies_, jointed_)) {
    Motion& motion = motions_[raised.body];
    const Eigen::Vector3d torque_spin =
        ToEigen(rigids_[raised.body]->getTotalTorque() *
                rigids_[raised.body]->getInvInertiaTensorWorld() * time_step_);
    // what gyroscopic terms turn a spin into is spin as well
    const Eigen::Vector3d spin = ToEigen(motion.spin + motion.external_spin) - torque_spin;
    const Eigen::Vector3d change = Eigen::Matrix3d(raised.response) * torque_spin - torque_spin +
                                   Eigen::Vector3d(raised.Damp(part, spin));
    for (int k = 0; k < 3; ++k) motion.external_spin[k] += static_cast<btScalar>(change[k]);
  }
}

const ContactEnd& BodyTable::Enter(const btCollisionObject& object) {
  const int index = object.getWorldArrayIndex();
  if (index >= static_cast<int>(slots_.size())) {
    slots_.resize(index + 1);
    ++growths_;
  }
  if (index >= 0 && slots_[index].substep != substep_) {
    Slot& slot = slots_[index];
    slot.object = &object;
    slot.substep = substep_;
    Fill(object, &slot.end);
    if (slot.end.reacts) bodies_[slot.end.number].id = NameOf(*rigids_[slot.end.number]);
    return slot.end;
  }
  Slot& slot = strangers_[&object];
  if (slot.substep != substep_) {
    slot.object = &object;
    slot.substep = substep_;
    Fill(object, &slot.end);
  }
  return slot.end;
}

btRigidBody* BodyTable::Describe(const btCollisionObject& object, ContactEnd* end) {
  using Object = btCollisionObject;
  const btVector3& at = object.getWorldTransform().getOrigin();
  for (int k = 0; k < 3; ++k) end->at[k] = at[k];
  end->number = kWorld;
  end->reacts = false;
  end->slides_unevenly = object.hasAnisotropicFriction(Object::CF_ANISOTROPIC_FRICTION);
  end->rolls_unevenly = object.hasAnisotropicFriction(Object::CF_ANISOTROPIC_ROLLING_FRICTION);
  // the solver of a world may write to its bodies, though manifolds hold them as const
  btRigidBody* const rigid = btRigidBody::upcast(const_cast<btCollisionObject*>(&object));
  if (rigid == nullptr) return nullptr;
  end->reacts = Reacts(*rigid);
  return end->reacts || rigid->isKinematicObject() ? rigid : nullptr;
}

void BodyTable::Fill(const btCollisionObject& object, ContactEnd* end) {
  btRigidBody* const rigid = Describe(object, end);
  if (rigid == nullptr) return;
  end->number = size();
  bodies_.push_back(ToBody(*rigid));
  motions_.push_back(MotionOf(*rigid, time_step_));
  rigids_.push_back(rigid);
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
