// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "cairn/bullet/constraint_solver.h"

namespace cairn::test {

/// Cairn's solver, counting how it is called.
class WatchedSolver : public bullet::ConstraintSolver {
 public:
  using ConstraintSolver::ConstraintSolver;

  void prepareSolve(int bodies, int manifolds) override {
    ++prepared;
    foreign = false;
    ConstraintSolver::prepareSolve(bodies, manifolds);
  }

  btScalar solveGroup(btCollisionObject** bodies, int num_bodies, btPersistentManifold** manifolds,
                      int num_manifolds, btTypedConstraint** constraints, int num_constraints,
                      const btContactSolverInfo& info, btIDebugDraw* debug_drawer,
                      btDispatcher* dispatcher) override {
    ++groups;
    most_manifolds = std::max(most_manifolds, num_manifolds);
    for (int i = 0; i < num_constraints; ++i) {
      foreign = foreign || constraints[i]->getConstraintType() >= MAX_CONSTRAINT_TYPE;
    }
    const btScalar result =
        ConstraintSolver::solveGroup(bodies, num_bodies, manifolds, num_manifolds, constraints,
                                     num_constraints, info, debug_drawer, dispatcher);
    if (fell_back()) ++fallbacks;
    return result;
  }

  int prepared = 0, groups = 0, fallbacks = 0;
  int most_manifolds = 0;  ///< in one group
  bool foreign = false;    ///< whether a joint of this substep is of a type that Bullet lacks
};

}  // namespace cairn::test
