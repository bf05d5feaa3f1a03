// SPDX-License-Identifier: MIT
#include "write_back.h"

#include <LinearMath/btTransformUtil.h>

#include "conversions.h"
#include "prefetch.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

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

bool IsFinite(const btTransform& pose) {
  double zero = 0;
  for (int k = 0; k < 3; ++k) {
    zero += 0 * pose.getOrigin()[k];
    for (int l = 0; l < 3; ++l) zero += 0 * pose.getBasis()[k][l];
  }
  return zero == 0;
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

void WriteBodies(const BodyTable& bodies, std::span<const Velocity> changes,
                 const SplitImpulse& pushes, const btContactSolverInfo& info) {
  constexpr int kAhead = 6;
  for (int i = 0; i < bodies.size(); ++i) {
    if (i + kAhead < bodies.size()) bodies.PrefetchVelocity(i + kAhead);
    if (!bodies.reacts(i)) continue;
    const Motion& motion = bodies.motion(i);
    btRigidBody& rigid = bodies.rigid(i);
    rigid.setLinearVelocity(motion.velocity + ToBullet(changes[i].linear) +
                            motion.external_velocity);
    rigid.setAngularVelocity(motion.spin + ToBullet(changes[i].angular) + motion.external_spin);
    if (!pushes.velocities().empty()) WritePush(pushes.velocities()[i], info, &rigid);
  }
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
