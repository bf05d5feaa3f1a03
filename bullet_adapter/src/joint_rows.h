// SPDX-License-Identifier: MIT
#pragma once

#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <span>
#include <vector>

#include "body_table.h"
#include "cairn/bullet/detail/group_rows.h"
#include "cairn/bullet/options.h"
#include "group/group.h"
#include "group_problem.h"
#include "joint_memory.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// Whether a joint, or every one, is of a class that Bullet ships. Classes of users go by Bullet's
/// own set-up: they may count on what it does around them. The type a joint states is all there is
/// to go by; which virtual functions a class overrides cannot be asked portably.
bool IsOfKnownType(const btTypedConstraint& joint);
bool AllOfKnownType(JointSpan joints);

/// Asks joints for their rows.
class JointRowBuilder {
 public:
  /// Prepares every joint for the substep, as Bullet does also for those that are disabled, and
  /// appends the rows of those that are enabled.
  /// @pre the memory has begun the group.
  void Append(JointSpan joints, const btContactSolverInfo& info, SweepLimits limits,
              ContactForm form);

  /// What Append() reads and fills; all must outlive the builder.
  JointRowBuilder(BodyTable* bodies, JointMemory* memory, GroupProblem* group)
      : bodies_(bodies), memory_(memory), group_(group) {}

  /// The most sweeps that a joint of the last Append() asked for.
  int most_sweeps() const { return most_sweeps_; }

 private:
  /// A row as btTypedConstraint::getInfo2() fills it. Joints write four scalars to an axis.
  struct alignas(16) Slot {
    btScalar linear_a[4], angular_a[4], linear_b[4], angular_b[4];
    btScalar error, cfm, lower, upper;
    btScalar share;   ///< Of the diagonal of a row that only turns: what angular factors leave.
    btScalar unseen;  ///< Of J v: of bodies that were taken out.
    bool drives;  ///< Has two bounds of its own, as motors and springs do: its error is a speed.
  };

  /// The bodies of a joint. Motions of those that have a number, none for others.
  struct Ends {
    const btRigidBody &a, &b;
    const Motion *motion_a, *motion_b;
    int body_a, body_b;
  };

  /// Returns the rows that were appended, none where neither body reacts.
  JointRows AppendJoint(btTypedConstraint* joint, const btContactSolverInfo& info,
                        SweepLimits limits, ContactForm form);
  /// Asks the joint for its rows. Returns their damping.
  btScalar FillSlots(btTypedConstraint* joint, const btContactSolverInfo& info);
  /// Where a body is strained, joints take back less of their errors.
  void TakeBackLess(int body_a, int body_b);
  /// Takes bodies out of rows that only turn, about axes that they are locked about, and finds
  /// Slot::share and Slot::unseen.
  void LookAtLocked(const Ends& ends);
  bool IsCompact() const;
  static btScalar Diagonal(const Ends& ends, const Slot& slot);
  /// What the core does not see of J v: static bodies have no number there, and may have a
  /// velocity.
  static btScalar UnseenSpeed(const Ends& ends, const Slot& slot);
  void AppendRow(const Ends& ends, const Row& common, const Slot& slot, btScalar damping);
  void AppendCompact(const Ends& ends, int max_sweeps, btScalar damping);

  BodyTable* bodies_;
  JointMemory* memory_;
  GroupProblem* group_;
  std::vector<Slot> slots_;
  int most_sweeps_ = 0;
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
