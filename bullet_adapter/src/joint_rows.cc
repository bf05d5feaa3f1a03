// SPDX-License-Identifier: MIT
#include "joint_rows.h"

#include <BulletDynamics/ConstraintSolver/btConeTwistConstraint.h>
#include <BulletDynamics/ConstraintSolver/btPoint2PointConstraint.h>

#include <algorithm>
#include <limits>
#include <typeinfo>

#include "cairn/detail/stiffness.h"
#include "conversions.h"
#include "prefetch.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

btVector3 ToVector(const btScalar* axis) { return {axis[0], axis[1], axis[2]}; }

/// What Bullet knows in doubles is not added up in floats: the core is then given targets that it
/// takes nothing from.
constexpr bool kTargetsInDouble = sizeof(btScalar) == sizeof(double);

/// Of that very class, of which no function is overridden.
bool IsConeTwist(const btTypedConstraint& joint) {
  return joint.getConstraintType() == CONETWIST_CONSTRAINT_TYPE &&
         typeid(joint) == typeid(btConeTwistConstraint);
}

/// Rows that the last getInfo2() wrote.
int RowsOf(btConeTwistConstraint* cone) {
  const bool both =
      cone->getSwingSpan1() < cone->getFixThresh() && cone->getSwingSpan2() < cone->getFixThresh();
  const int swing = !cone->isPastSwingLimit() ? 0 : both ? 2 : 1;
  return 3 + swing + (cone->getSolveTwistLimit() != 0 ? 1 : 0);
}

/// A point-to-point joint makes Jacobians that only its obsolete solver reads.
bool NeedsJacobian(const btTypedConstraint& joint) {
  return joint.getConstraintType() != POINT2POINT_CONSTRAINT_TYPE ||
         typeid(joint) != typeid(btPoint2PointConstraint);
}

/// What Bullet does to a joint before a substep, enabled or not.
void Prepare(btTypedConstraint* joint) {
  if (NeedsJacobian(*joint)) joint->buildJacobian();
  joint->internalSetAppliedImpulse(0);
  btJointFeedback* const feedback = joint->getJointFeedback();
  if (feedback == nullptr) return;
  feedback->m_appliedForceBodyA.setZero();
  feedback->m_appliedTorqueBodyA.setZero();
  feedback->m_appliedForceBodyB.setZero();
  feedback->m_appliedTorqueBodyB.setZero();
}

/// A row that only turns moves a body with an angular factor if that answers at least this share of
/// what it would without the factor. The core knows the inertia with its factor alone.
constexpr btScalar kLeastShare = btScalar(1e-3);
/// From here on locks change nothing that matters, as of a hinge whose axis is that of a plane's.
constexpr btScalar kWholeShare = btScalar(0.99);

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

/// Of a body that has no number: what has one is seen by the core.
bool StandsStill(const btRigidBody& rigid, const Motion* motion) {
  return motion != nullptr ||
         (rigid.getLinearVelocity().isZero() && rigid.getAngularVelocity().isZero());
}

void Put(const btScalar* from, float* to) {
  for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(from[k]);
}

}  // namespace

bool IsOfKnownType(const btTypedConstraint& joint) {
  switch (joint.getConstraintType()) {
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
}

bool AllOfKnownType(JointSpan joints) {
  return std::ranges::all_of(joints, [](const auto* joint) { return IsOfKnownType(*joint); });
}

void JointRowBuilder::Append(JointSpan joints, const btContactSolverInfo& info, SweepLimits limits,
                             ContactForm form) {
  most_sweeps_ = 0;
  constexpr size_t kAhead = 2;
  for (size_t place = 0; place < joints.size(); ++place) {
    if (place + kAhead < joints.size()) PrefetchJoint(*joints[place + kAhead], kMostOfJoint);
    if (place + 1 < joints.size()) PrefetchBodies(*joints[place + 1]);
    Prepare(joints[place]);
    if (!joints[place]->isEnabled()) continue;
    const JointRows appended = AppendJoint(joints[place], info, limits, form);
    if (appended.rows == 0) continue;
    group_->joints.push_back(appended);
    memory_->Start(static_cast<int>(place), appended, group_);
  }
}

JointRows JointRowBuilder::AppendJoint(btTypedConstraint* joint, const btContactSolverInfo& info,
                                       SweepLimits limits, ContactForm form) {
  JointRows result;
  result.joint = joint;
  const btScalar damping = FillSlots(joint, info);
  if (slots_.empty()) return result;

  const int own = joint->getOverrideNumSolverIterations();
  const int sweeps = own > 0 ? own : info.m_numIterations;
  most_sweeps_ = std::max(most_sweeps_, sweeps);
  const btRigidBody &a = joint->getRigidBodyA(), &b = joint->getRigidBodyB();
  const ContactEnd end_a = bodies_->EndOf(a), end_b = bodies_->EndOf(b);
  // nothing comes of a joint of a body with itself
  if ((!end_a.reacts && !end_b.reacts) || &a == &b) return result;
  const int max_sweeps = limits == SweepLimits::kBullet ? sweeps : std::numeric_limits<int>::max();

  result.a_moves = end_a.number != kWorld;
  result.b_moves = end_b.number != kWorld;
  result.rows = static_cast<int>(slots_.size());
  const auto motion = [this](int number) {
    return number == kWorld ? nullptr : &bodies_->motion(number);
  };
  const Ends ends{a, b, motion(end_a.number), motion(end_b.number), end_a.number, end_b.number};
  TakeBackLess(ends.body_a, ends.body_b);
  LookAtLocked(ends);
  result.written_out = form == ContactForm::kRows || !IsCompact();
  if (result.written_out) {
    result.first_row = static_cast<int>(group_->rows.size());
    const Row common{
        .body_a = ends.body_a, .body_b = ends.body_b, .host = {.max_sweeps = max_sweeps}};
    for (const Slot& slot : slots_) AppendRow(ends, common, slot, damping);
  } else {
    result.first_row = static_cast<int>(group_->joint_rows.size());
    AppendCompact(ends, max_sweeps, damping);
  }
  return result;
}

void JointRowBuilder::TakeBackLess(int body_a, int body_b) {
  const auto strain = [this](int body) {
    return body == kWorld ? 0 : bodies_->bodies()[body].strain;
  };
  const double share = ShareOfErp(std::max(strain(body_a), strain(body_b)));
  if (share == 1) return;
  for (Slot& slot : slots_) {
    if (!slot.drives) slot.error *= static_cast<btScalar>(share);
  }
}

void JointRowBuilder::LookAtLocked(const Ends& ends) {
  const btVector3 none(0, 0, 0);
  const auto has_factor = [](const btRigidBody& rigid) {
    return rigid.getAngularFactor() != btVector3(1, 1, 1);
  };
  if (!has_factor(ends.a) && !has_factor(ends.b)) return;
  for (Slot& slot : slots_) {
    if (!ToVector(slot.linear_a).isZero() || !ToVector(slot.linear_b).isZero()) continue;
    btScalar with = 0, without = 0;
    const auto look = [&](const btRigidBody& rigid, const Motion* motion, btScalar* angular) {
      const btVector3 axis = ToVector(angular);
      const btScalar free = HalfDiagonal(rigid, none, axis * rigid.getAngularFactor());
      const btScalar all = HalfDiagonal(rigid, none, axis);
      if (free >= kLeastShare * all) {
        with += free;
        without += all;
        return;
      }
      // it keeps its spin, which is no longer seen
      slot.unseen += HalfSpeed(rigid, motion, none, axis);
      std::fill_n(angular, 3, btScalar(0));
    };
    look(ends.a, ends.motion_a, slot.angular_a);
    look(ends.b, ends.motion_b, slot.angular_b);
    slot.share = with < kWholeShare * without ? with / without : btScalar(1);
  }
}

btScalar JointRowBuilder::FillSlots(btTypedConstraint* joint, const btContactSolverInfo& info) {
  // a cone-twist joint finds out twice where it is, for the number of its rows and for the rows
  auto* const cone = IsConeTwist(*joint) ? static_cast<btConeTwistConstraint*>(joint) : nullptr;
  btTypedConstraint::btConstraintInfo1 size{};
  if (cone != nullptr) {
    cone->getInfo1NonVirtual(&size);  // the most that there are
  } else {
    joint->getInfo1(&size);
  }
  Slot empty{};
  empty.lower = -SIMD_INFINITY;
  empty.upper = SIMD_INFINITY;
  empty.share = 1;
  slots_.assign(std::max(0, size.m_numConstraintRows), empty);
  if (slots_.empty()) return 0;
  Slot& first = slots_[0];
  first.cfm = NotBelowZero(info.m_globalCfm);  // of the first row only, as in Bullet

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
  if (cone != nullptr) slots_.resize(RowsOf(cone));

  const btScalar breaking = NotBelowZero(joint->getBreakingImpulseThreshold());
  for (Slot& slot : slots_) {
    slot.cfm = NotBelowZero(slot.cfm);
    slot.drives = slot.lower > -SIMD_INFINITY && slot.upper < SIMD_INFINITY;
    // a motor with a negative strength has none
    if (slot.lower > slot.upper) slot.lower = slot.upper = 0;
    if (slot.upper >= breaking) slot.upper = breaking;
    if (slot.lower <= -breaking) slot.lower = -breaking;
  }
  return query.m_damping;
}

bool JointRowBuilder::IsCompact() const {
  // the CFM of Bullet is also a step length, and so is what locks leave of the diagonal
  return slots_.size() <= Joint::kMostRows && std::ranges::all_of(slots_, [](const Slot& slot) {
           return slot.cfm == 0 && slot.share == 1;
         });
}

void JointRowBuilder::AppendCompact(const Ends& ends, int max_sweeps, btScalar damping) {
  std::vector<JointRow>& rows = group_->joint_rows;
  Joint& joint = group_->compact_joints.emplace_back(
      Joint{.body_a = ends.body_a,
            .body_b = ends.body_b,
            .first_row = static_cast<int>(rows.size()),
            .rows = static_cast<int>(slots_.size()),
            .damping = kTargetsInDouble ? 0 : static_cast<float>(damping),
            .opposite = true,
            .host = {.max_sweeps = max_sweeps}});
  const bool still =
      !kTargetsInDouble && StandsStill(ends.a, ends.motion_a) && StandsStill(ends.b, ends.motion_b);
  const btScalar inv_mass_a = ends.a.getInvMass(), inv_mass_b = ends.b.getInvMass();
  rows.resize(rows.size() + slots_.size());
  group_->joint_errors.resize(rows.size());
  group_->joint_impulses.resize(rows.size());
  for (size_t i = 0; i < slots_.size(); ++i) {
    const Slot& slot = slots_[i];
    JointRow& row = rows[joint.first_row + i];
    row.lo = static_cast<float>(Bound(slot.lower));
    row.hi = static_cast<float>(Bound(slot.upper));
    const btVector3 linear_a = ToVector(slot.linear_a), linear_b = ToVector(slot.linear_b);
    const btScalar a2 = linear_a.length2(), b2 = linear_b.length2();
    joint.opposite = joint.opposite && (linear_a + linear_b).isZero();
    if (a2 + b2 == 0) joint.angular |= 1u << i;
    if (row.lo > -kInfinity || row.hi < kInfinity) joint.bounded |= 1u << i;
    // one that pushes nothing asks for nothing
    const bool pushes = a2 * inv_mass_a + b2 * inv_mass_b > SIMD_EPSILON;
    if (!pushes && !(Diagonal(ends, slot) > SIMD_EPSILON)) continue;
    Put(slot.linear_a, row.linear_a);
    Put(slot.angular_a, row.angular_a);
    Put(slot.linear_b, row.linear_b);
    Put(slot.angular_b, row.angular_b);
    double target = slot.error;
    if (!still || slot.unseen != 0) {
      target -= static_cast<double>(UnseenSpeed(ends, slot) * damping);
    }
    row.target = static_cast<float>(std::clamp(target, -kMostTarget, kMostTarget));
    if (slot.drives || joint.is_bounded(static_cast<int>(i))) continue;
    const double error = slot.error;
    group_->joint_errors[joint.first_row + i] =
        static_cast<float>(std::clamp(error, -kMostTarget, kMostTarget));
  }
}

btScalar JointRowBuilder::Diagonal(const Ends& ends, const Slot& slot) {
  return HalfDiagonal(ends.a, ToVector(slot.linear_a), ToVector(slot.angular_a)) +
         HalfDiagonal(ends.b, ToVector(slot.linear_b), ToVector(slot.angular_b));
}

btScalar JointRowBuilder::UnseenSpeed(const Ends& ends, const Slot& slot) {
  btScalar speed = slot.unseen;
  if (kTargetsInDouble || ends.motion_a == nullptr) {
    speed += HalfSpeed(ends.a, ends.motion_a, ToVector(slot.linear_a), ToVector(slot.angular_a));
  }
  if (kTargetsInDouble || ends.motion_b == nullptr) {
    speed += HalfSpeed(ends.b, ends.motion_b, ToVector(slot.linear_b), ToVector(slot.angular_b));
  }
  return speed;
}

void JointRowBuilder::AppendRow(const Ends& ends, const Row& common, const Slot& slot,
                                btScalar damping) {
  const btVector3 linear_a = ToVector(slot.linear_a), angular_a = ToVector(slot.angular_a);
  const btVector3 linear_b = ToVector(slot.linear_b), angular_b = ToVector(slot.angular_b);
  Row& row = group_->Append(common, 0);
  row.linear_a = ToEigen(linear_a);
  row.angular_a = ToEigen(angular_a);
  row.linear_b = ToEigen(linear_b);
  row.angular_b = ToEigen(angular_b);
  row.lo = Bound(slot.lower);
  row.hi = Bound(slot.upper);
  // Bullet's D leaves the cfm of a joint out, and the factors of bodies
  row.relaxation = Relaxation((1 + slot.cfm) * slot.share);

  // most rows are rigid and push a mass: of their diagonal it is enough to know that there is one
  const btScalar pushed =
      linear_a.length2() * ends.a.getInvMass() + linear_b.length2() * ends.b.getInvMass();
  btScalar diagonal = pushed;
  if (slot.cfm != 0 || !(pushed > SIMD_EPSILON)) {
    diagonal = Diagonal(ends, slot);
    if (!(btFabs(diagonal) > SIMD_EPSILON)) return;
  }
  const btScalar speed = HalfSpeed(ends.a, ends.motion_a, linear_a, angular_a) +
                         HalfSpeed(ends.b, ends.motion_b, linear_b, angular_b) + slot.unseen;
  const double target = static_cast<double>(slot.error) - static_cast<double>(speed * damping);
  row.target = std::clamp(target, -kMostTarget, kMostTarget);
  row.compliance = static_cast<double>(slot.cfm) * diagonal;
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
