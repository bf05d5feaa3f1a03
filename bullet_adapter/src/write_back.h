// SPDX-License-Identifier: MIT
#pragma once

#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>

#include <span>

#include "body_table.h"
#include "cairn/bullet/precision.h"
#include "contacts/split_impulse.h"
#include "group_problem.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// Whether Bullet's numbers, floats perhaps, hold the impulses of rows, and the motion of all
/// bodies that came with one that they hold.
bool FitsBullet(const GroupProblem& group, const BodyTable& bodies,
                std::span<const Velocity> changes, detail::Threads* threads);

/// Writes impulses to the contact points, if the solver mode has warm starts, as Bullet does: the
/// second lateral one only where there are two directions of friction.
void WriteContacts(const GroupProblem& group, const btContactSolverInfo& info);

/// Writes applied impulses and feedback to the joints, and disables those that break.
void WriteJoints(const GroupProblem& group, const btContactSolverInfo& info);

/// How bodies moved in the parts of a step.
struct PartedMotion {
  std::span<const Velocity> changes;  ///< of the velocities, one per body of the table
  std::span<const Velocity> means;    ///< the same on average over the parts
  int parts;
};

/// Moves the bodies that react by what they moved in the parts of a step, less what Bullet moves
/// them by with their velocity in the end.
void MoveBodies(const BodyTable& bodies, const PartedMotion& motion,
                const btContactSolverInfo& info);

/// Writes velocities to the bodies that react, and moves those that are pushed out of penetration.
/// @param changes  of the velocities, one per body of the table
void WriteBodies(const BodyTable& bodies, std::span<const Velocity> changes,
                 const SplitImpulse& pushes, const btContactSolverInfo& info,
                 detail::Threads* threads);

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
