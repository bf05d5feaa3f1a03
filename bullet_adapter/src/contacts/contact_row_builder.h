// SPDX-License-Identifier: MIT
#pragma once

#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>

#include "body_table.h"
#include "cairn/bullet/detail/group_rows.h"
#include "contacts/contact_input.h"
#include "contacts/split_impulse.h"
#include "group_problem.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// What the contacts of a group share.
struct ContactTerms {
  ContactTerms(const btContactSolverInfo& info, SweepLimits limits);

  btScalar time_step;              ///< [s]
  btScalar restitution_threshold;  ///< Nothing bounces below this speed [m/s].
  bool splits;                     ///< Deep penetration is pushed out beside the velocities.
  btScalar split_threshold;        ///< What is deep: distances up to this [m].
  btScalar over_relaxation;        ///< Bullet's step is this much longer [1].
  Row row;                         ///< Step length and most sweeps of normals and friction.
};

/// Turns what was read of manifolds into rows: the normals of the points of a manifold, then their
/// friction, then what resists rolling.
class ContactRowBuilder {
 public:
  /// All must outlive the builder. Deep penetration goes to @p pushes instead of the target of its
  /// normal.
  ContactRowBuilder(const ContactTerms& terms, const BodyTable& bodies, GroupProblem* group,
                    SplitImpulse* pushes)
      : terms_(terms), bodies_(bodies), group_(group), pushes_(pushes), row_(terms.row) {}

  void Append(const ManifoldInput& manifold);

 private:
  /// A body of the present manifold: none and at rest for the world.
  struct Side {
    const btRigidBody* rigid;
    btVector3 velocity, spin;       ///< Before the step: what bounces.
    btVector3 driven, driven_spin;  ///< With what forces and torques add over the step.
  };

  Side SideOf(int number) const;
  Axes AxesAlong(const btVector3& direction, const ContactInput& input) const;
  /// Appends a row along some axes.
  Row& AppendRow(const Axes& axes, double impulse);
  btScalar Bounce(const ContactInput& input, const Axes& axes) const;
  btScalar TangentSpeed(const Axes& axes) const;

  int AppendNormal(const ContactInput& input);
  void AppendFriction(const ContactInput& input, int tangents, PointRows* rows);
  void AppendTwists(const ContactInput& input, PointRows* rows);

  const ContactTerms& terms_;
  const BodyTable& bodies_;
  GroupProblem* group_;
  SplitImpulse* pushes_;
  Row row_;  ///< What all rows of the present manifold share.
  Side a_, b_;
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
