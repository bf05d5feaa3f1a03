// SPDX-License-Identifier: MIT
#include "measure/row_recorder.h"

namespace cairn::bench {

btScalar RowRecorder::solveGroupCacheFriendlyIterations(
    btCollisionObject** bodies, int num_bodies, btPersistentManifold** manifolds, int num_manifolds,
    btTypedConstraint** constraints, int num_constraints, const btContactSolverInfo& info,
    btIDebugDraw* debug_drawer) {
  if (frame_ != nullptr) Record(info);
  return btSequentialImpulseConstraintSolver::solveGroupCacheFriendlyIterations(
      bodies, num_bodies, manifolds, num_manifolds, constraints, num_constraints, info,
      debug_drawer);
}

void RowRecorder::Record(const btContactSolverInfo& info) {
  rows_.Read({&m_tmpSolverBodyPool, &m_tmpSolverNonContactConstraintPool,
              &m_tmpSolverContactConstraintPool, &m_tmpSolverContactFrictionConstraintPool,
              &m_tmpSolverContactRollingFrictionConstraintPool},
             info, bullet::SweepLimits::kNone);
  const ContactProblem problem = rows_.problem();
  frame_->bodies.assign(problem.bodies.begin(), problem.bodies.end());
  frame_->rows.assign(problem.rows.begin(), problem.rows.end());
  frame_->impulses.assign(rows_.impulses().begin(), rows_.impulses().end());
  frame_ = nullptr;
}

}  // namespace cairn::bench
