// SPDX-License-Identifier: MIT
#include "write_back.h"

#include <LinearMath/btTransformUtil.h>

#include <atomic>

#include "conversions.h"
#include "prefetch.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

/// As many are written by one thread at a time.
constexpr int kBodiesOfPart = 256;

/// A joint breaks at its bound, which sweeps in floats may round down.
constexpr btScalar kFloatRounding = btScalar(1e-6);

/// @p row: a Row or a JointRow
template <class AnyRow>
void AddFeedback(const AnyRow& row, btScalar force, const btTypedConstraint& joint,
                 btJointFeedback* feedback) {
  const btRigidBody &a = joint.getRigidBodyA(), &b = joint.getRigidBodyB();
  feedback->m_appliedForceBodyA += ToBullet(row.linear_a) * force * a.getLinearFactor();
  feedback->m_appliedForceBodyB += ToBullet(row.linear_b) * force * b.getLinearFactor();
  feedback->m_appliedTorqueBodyA += ToBullet(row.angular_a) * force * a.getAngularFactor();
  feedback->m_appliedTorqueBodyB += ToBullet(row.angular_b) * force * b.getAngularFactor();
}

/// 0 where all three are finite.
btScalar ZeroTimes(const btVector3& value) { return 0 * value.x() + 0 * value.y() + 0 * value.z(); }

btVector3 VelocityAfter(const Motion& motion, const Velocity& change) {
  return motion.velocity + ToBullet(change.linear) + motion.external_velocity;
}

btVector3 SpinAfter(const Motion& motion, const Velocity& change) {
  return motion.spin + ToBullet(change.angular) + motion.external_spin;
}

bool IsFinite(const btTransform& pose) {
  const btMatrix3x3& basis = pose.getBasis();
  return ZeroTimes(pose.getOrigin()) + ZeroTimes(basis[0]) + ZeroTimes(basis[1]) +
             ZeroTimes(basis[2]) ==
         0;
}

/// No row sees what pushes are made of, an ERP that is no number among it: nobody refused that.
void WritePush(const PushVelocity& push, const btContactSolverInfo& info, btRigidBody* rigid) {
  if (push.linear.isZero() && push.angular.isZero()) return;
  btTransform moved;
  btTransformUtil::integrateTransform(rigid->getWorldTransform(), push.linear,
                                      push.angular * info.m_splitImpulseTurnErp, info.m_timeStep,
                                      moved);
  if (IsFinite(moved)) rigid->setWorldTransform(moved);
}

}  // namespace

bool FitsBullet(const GroupProblem& group, const BodyTable& bodies,
                std::span<const Velocity> changes, detail::Threads* threads) {
  btScalar none = 0;
  for (const double impulse : group.impulses) none += 0 * static_cast<btScalar>(impulse);
  std::atomic<bool> fits = none == 0;
  const auto look = [&](int first, int count) {
    btScalar zero = 0;
    for (int i = first; i < first + count; ++i) {
      if (!bodies.reacts(i)) continue;
      const Motion& motion = bodies.motion(i);
      const btScalar before = ZeroTimes(motion.velocity + motion.external_velocity) +
                              ZeroTimes(motion.spin + motion.external_spin);
      if (before != 0) continue;
      zero +=
          ZeroTimes(VelocityAfter(motion, changes[i])) + ZeroTimes(SpinAfter(motion, changes[i]));
    }
    if (zero != 0) fits.store(false, std::memory_order_relaxed);
  };
  threads->For(bodies.size(), kBodiesOfPart, look, {SpanKind::kResults});
  return fits;
}

void WriteContacts(const GroupProblem& group, const btContactSolverInfo& info) {
  const bool warm_starts = (info.m_solverMode & SOLVER_USE_WARMSTARTING) != 0;
  for (const PointRows& rows : group.points) {
    btManifoldPoint& point = *rows.point;
    point.m_contactPointFlags |= rows.left.flags;
    if (!warm_starts) continue;
    const double* const friction = group.impulses.data() + rows.friction_row;
    point.m_appliedImpulse = static_cast<btScalar>(group.impulses[rows.normal_row]);
    point.m_appliedImpulseLateral1 = static_cast<btScalar>(friction[0]);
    if (rows.frictions > 1) point.m_appliedImpulseLateral2 = static_cast<btScalar>(friction[1]);
    point.m_prevRHS = rows.left.heading;
  }
}

void WriteJoints(const GroupProblem& group, const btContactSolverInfo& info) {
  constexpr size_t kAhead = 4;
  for (size_t i = 0; i < group.joints.size(); ++i) {
    if (i + kAhead < group.joints.size()) {
      PrefetchJoint(*group.joints[i + kAhead].joint, kHeadOfJoint);
    }
    const JointRows& rows = group.joints[i];
    btTypedConstraint& joint = *rows.joint;
    btJointFeedback* const feedback = joint.getJointFeedback();
    const btScalar breaking = joint.getBreakingImpulseThreshold() * (1 - kFloatRounding);
    for (int row = 0; row < rows.rows; ++row) {
      const auto impulse = static_cast<btScalar>(group.impulse(rows, row));
      if (feedback != nullptr) {
        const btScalar force = impulse / info.m_timeStep;
        const int at = rows.first_row + row;
        if (rows.written_out) {
          AddFeedback(group.rows[at], force, joint, feedback);
        } else {
          AddFeedback(group.joint_rows[at], force, joint, feedback);
        }
      }
      joint.internalSetAppliedImpulse(impulse);
      if (btFabs(impulse) >= breaking) joint.setEnabled(false);
    }
  }
}

void MoveBodies(const BodyTable& bodies, const PartedMotion& parted,
                const btContactSolverInfo& info) {
  // external impulses act in equal parts
  const btScalar pushed = btScalar(parted.parts + 1) / btScalar(2 * parted.parts);
  for (int i = 0; i < bodies.size(); ++i) {
    // what Bullet does not move, stays
    if (!bodies.reacts(i) || !bodies.rigid(i).isActive()) continue;
    const Motion& motion = bodies.motion(i);
    const Velocity& mean = parted.means[i];
    const btVector3 velocity = VelocityAfter(motion, parted.changes[i]);
    const btVector3 spin = SpinAfter(motion, parted.changes[i]);
    const btVector3 way =
        motion.velocity + ToBullet(mean.linear) + motion.external_velocity * pushed;
    const btVector3 turn = motion.spin + ToBullet(mean.angular) + motion.external_spin * pushed;
    // Bullet turns it by the spin, after that
    btTransform by_bullet;
    btTransformUtil::integrateTransform(btTransform::getIdentity(), btVector3(0, 0, 0), spin,
                                        info.m_timeStep, by_bullet);
    const btScalar angle = turn.length() * info.m_timeStep;
    const btQuaternion whole =
        angle > 0 ? btQuaternion(turn.normalized(), angle) : btQuaternion::getIdentity();
    btRigidBody& rigid = bodies.rigid(i);
    const btTransform& pose = rigid.getWorldTransform();
    const btQuaternion turned = by_bullet.getRotation().inverse() * whole * pose.getRotation();
    const btTransform moved(turned.normalized(),
                            pose.getOrigin() + (way - velocity) * info.m_timeStep);
    if (IsFinite(moved)) rigid.setWorldTransform(moved);
  }
}

namespace {

/// Of bodies from one number on, up to another one.
void WriteBodies(const BodyTable& bodies, std::span<const Velocity> changes,
                 const SplitImpulse& pushes, const btContactSolverInfo& info, int first, int end) {
  constexpr int kAhead = 6;
  for (int i = first; i < end; ++i) {
    if (i + kAhead < end) bodies.PrefetchVelocity(i + kAhead);
    if (!bodies.reacts(i)) continue;
    const Motion& motion = bodies.motion(i);
    btRigidBody& rigid = bodies.rigid(i);
    rigid.setLinearVelocity(VelocityAfter(motion, changes[i]));
    rigid.setAngularVelocity(SpinAfter(motion, changes[i]));
    if (!pushes.velocities().empty()) WritePush(pushes.velocities()[i], info, &rigid);
  }
}

}  // namespace

void WriteBodies(const BodyTable& bodies, std::span<const Velocity> changes,
                 const SplitImpulse& pushes, const btContactSolverInfo& info,
                 detail::Threads* threads) {
  const auto write = [&](int first, int count) {
    WriteBodies(bodies, changes, pushes, info, first, first + count);
  };
  threads->For(bodies.size(), kBodiesOfPart, write, {SpanKind::kWrite});
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
