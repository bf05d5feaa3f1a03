// SPDX-License-Identifier: MIT
#include "joint_rows.h"

#include <algorithm>

#include "conversions.h"
#include "prefetch.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

btVector3 ToVector(const btScalar* axis) { return {axis[0], axis[1], axis[2]}; }

/// What Bullet does to a joint before a substep, enabled or not.
void Prepare(btTypedConstraint* joint) {
  joint->buildJacobian();
  joint->internalSetAppliedImpulse(0);
  btJointFeedback* const feedback = joint->getJointFeedback();
  if (feedback == nullptr) return;
  feedback->m_appliedForceBodyA.setZero();
  feedback->m_appliedTorqueBodyA.setZero();
  feedback->m_appliedForceBodyB.setZero();
  feedback->m_appliedTorqueBodyB.setZero();
}

/// J M^-1 J' of one half of a row, without the factors of the body: what Bullet makes its step of.
btScalar HalfDiagonal(const btRigidBody& rigid, const btVector3& linear, const btVector3& angular) {
  return linear.length2() * rigid.getInvMass() +
         (rigid.getInvInertiaTensorWorld() * angular).dot(angular);
}

/// J v of one half of a row, with all that is known of v. Joints see the velocity of static bodies,
/// too.
btScalar HalfSpeed(const btRigidBody& rigid, const Motion* motion, const btVector3& linear,
                   const btVector3& angular) {
  if (motion == nullptr) {
    return linear.dot(rigid.getLinearVelocity()) + angular.dot(rigid.getAngularVelocity());
  }
  return linear.dot(motion->velocity + motion->external_velocity) +
         angular.dot(motion->spin + motion->external_spin);
}

}  // namespace

bool AllOfKnownType(Joints joints) {
  return std::ranges::all_of(joints, [](const btTypedConstraint* joint) {
    switch (joint->getConstraintType()) {
      case POINT2POINT_CONSTRAINT_TYPE:
      case HINGE_CONSTRAINT_TYPE:
      case CONETWIST_CONSTRAINT_TYPE:
      case D6_CONSTRAINT_TYPE:
      case SLIDER_CONSTRAINT_TYPE:
      case D6_SPRING_CONSTRAINT_TYPE:
      case GEAR_CONSTRAINT_TYPE:
      case FIXED_CONSTRAINT_TYPE:
      case D6_SPRING_2_CONSTRAINT_TYPE:
        return true;
      default:
        return false;
    }
  });
}

void JointRowBuilder::Append(Joints joints, const btContactSolverInfo& info, SweepLimits limits) {
  most_sweeps_ = 0;
  constexpr size_t kAhead = 2;
  for (btTypedConstraint* joint : joints) Prepare(joint);
  for (size_t place = 0; place < joints.size(); ++place) {
    if (place + kAhead < joints.size()) PrefetchJoint(*joints[place + kAhead], kMostOfJoint);
    if (!joints[place]->isEnabled()) continue;
    const JointRows appended = AppendJoint(joints[place], info, limits);
    if (appended.rows == 0) continue;
    group_->joints.push_back(appended);
    memory_->Start(static_cast<int>(place), appended, group_);
  }
}

JointRows JointRowBuilder::AppendJoint(btTypedConstraint* joint, const btContactSolverInfo& info,
                                       SweepLimits limits) {
  btTypedConstraint::btConstraintInfo1 size{};
  joint->getInfo1(&size);
  JointRows result{joint, static_cast<int>(group_->rows.size()), 0};
  if (size.m_numConstraintRows <= 0) return result;
  const btScalar damping = FillSlots(joint, size.m_numConstraintRows, info);

  const int own = joint->getOverrideNumSolverIterations();
  const int sweeps = own > 0 ? own : info.m_numIterations;
  most_sweeps_ = std::max(most_sweeps_, sweeps);
  const btRigidBody &a = joint->getRigidBodyA(), &b = joint->getRigidBodyB();
  Row law{.body_a = bodies_->Number(a), .body_b = bodies_->Number(b)};
  if (!bodies_->reacts(law.body_a) && !bodies_->reacts(law.body_b)) return result;
  if (limits == SweepLimits::kBullet) law.max_sweeps = sweeps;

  result.rows = size.m_numConstraintRows;
  const auto motion = [this](int number) {
    return number == kWorld ? nullptr : &bodies_->motion(number);
  };
  const Ends ends{a, b, motion(law.body_a), motion(law.body_b), law};
  for (const Slot& slot : slots_) AppendRow(ends, slot, damping);
  return result;
}

btScalar JointRowBuilder::FillSlots(btTypedConstraint* joint, int rows,
                                    const btContactSolverInfo& info) {
  Slot empty{};
  empty.lower = -SIMD_INFINITY;
  empty.upper = SIMD_INFINITY;
  slots_.assign(rows, empty);
  Slot& first = slots_[0];
  first.cfm = info.m_globalCfm;  // of the first row only, as in Bullet

  btTypedConstraint::btConstraintInfo2 query{};
  query.fps = btScalar(1) / info.m_timeStep;
  query.erp = info.m_erp;
  query.m_J1linearAxis = first.linear_a;
  query.m_J1angularAxis = first.angular_a;
  query.m_J2linearAxis = first.linear_b;
  query.m_J2angularAxis = first.angular_b;
  query.rowskip = sizeof(Slot) / sizeof(btScalar);
  query.m_constraintError = &first.error;
  query.cfm = &first.cfm;
  query.m_lowerLimit = &first.lower;
  query.m_upperLimit = &first.upper;
  // springs scale their force by it, so it is not the number of sweeps made here
  query.m_numIterations = info.m_numIterations;
  query.m_damping = info.m_damping;
  joint->getInfo2(&query);

  const btScalar breaking = joint->getBreakingImpulseThreshold();
  for (Slot& slot : slots_) {
    if (slot.upper >= breaking) slot.upper = breaking;
    if (slot.lower <= -breaking) slot.lower = -breaking;
  }
  return query.m_damping;
}

void JointRowBuilder::AppendRow(const Ends& ends, const Slot& slot, btScalar damping) {
  const btVector3 linear_a = ToVector(slot.linear_a), angular_a = ToVector(slot.angular_a);
  const btVector3 linear_b = ToVector(slot.linear_b), angular_b = ToVector(slot.angular_b);
  Row& row = group_->Append(ends.law, 0);
  row.linear_a = ToEigen(linear_a);
  row.angular_a = ToEigen(angular_a);
  row.linear_b = ToEigen(linear_b);
  row.angular_b = ToEigen(angular_b);
  row.lo = Bound(slot.lower);
  row.hi = Bound(slot.upper);
  row.relaxation = Relaxation(1 + slot.cfm);  // Bullet's D leaves the cfm of a joint out

  // most rows are rigid and push a mass: of their diagonal it is enough to know that there is one
  const btScalar pushed =
      linear_a.length2() * ends.a.getInvMass() + linear_b.length2() * ends.b.getInvMass();
  btScalar diagonal = pushed;
  if (slot.cfm != 0 || !(pushed > SIMD_EPSILON)) {
    diagonal =
        HalfDiagonal(ends.a, linear_a, angular_a) + HalfDiagonal(ends.b, linear_b, angular_b);
    if (!(btFabs(diagonal) > SIMD_EPSILON)) return;
  }
  const btScalar speed = HalfSpeed(ends.a, ends.motion_a, linear_a, angular_a) +
                         HalfSpeed(ends.b, ends.motion_b, linear_b, angular_b);
  const double target = static_cast<double>(slot.error) - static_cast<double>(speed * damping);
  row.target = std::clamp(target, -kMostTarget, kMostTarget);
  row.compliance = static_cast<double>(slot.cfm) * diagonal;
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
