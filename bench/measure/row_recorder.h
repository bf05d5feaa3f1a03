// SPDX-License-Identifier: MIT
#pragma once

#include <btBulletDynamicsCommon.h>

#include "cairn/bullet/detail/group_rows.h"
#include "measure/contact_frame.h"

namespace cairn::bench {

/// Bullet's own solver, and what it was asked: the rows of a group, with impulses as the warm start
/// left them, as the adapter sees it.
class RowRecorder : public btSequentialImpulseConstraintSolver {
 public:
  /// Records the next group, once; nullptr records nothing.
  void RecordTo(ContactFrame* frame) { frame_ = frame; }

 protected:
  btScalar solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int num_bodies,
                                             btPersistentManifold** manifolds, int num_manifolds,
                                             btTypedConstraint** constraints, int num_constraints,
                                             const btContactSolverInfo& info,
                                             btIDebugDraw* debug_drawer) override;

 private:
  void Record(const btContactSolverInfo& info);

  ContactFrame* frame_ = nullptr;
  bullet::GroupRows rows_;
};

}  // namespace cairn::bench
