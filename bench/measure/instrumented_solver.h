// SPDX-License-Identifier: MIT
#pragma once

#include <btBulletDynamicsCommon.h>

#include <chrono>
#include <functional>
#include <utility>

#include "measure/substep.h"

namespace cairn::bench {

/// Stands between a world and the solver under test: times it, and on request hands the state of a
/// substep to a probe before the solver gets it.
class InstrumentedSolver : public btConstraintSolver {
 public:
  /// May give the substep to other solvers; it is restored afterwards.
  using Probe = std::function<void(Substep*, const btContactSolverInfo&)>;

  /// @p solver is not owned.
  explicit InstrumentedSolver(btConstraintSolver* solver) : solver_(solver) {}

  /// Calls @p probe in the next substep.
  void ProbeNext(Probe probe) { probe_ = std::move(probe); }
  /// Time inside the solver since the last call, from the first prepareSolve() to the end of
  /// allSolved(); probing and the world's work between groups not counted.
  std::chrono::nanoseconds TakeTime();

  void prepareSolve(int num_bodies, int num_manifolds) override;
  btScalar solveGroup(btCollisionObject** bodies, int num_bodies, btPersistentManifold** manifolds,
                      int num_manifolds, btTypedConstraint** joints, int num_joints,
                      const btContactSolverInfo& info, btIDebugDraw* debug_drawer,
                      btDispatcher* dispatcher) override;
  void allSolved(const btContactSolverInfo& info, btIDebugDraw* debug_drawer) override;
  void reset() override { solver_->reset(); }
  btConstraintSolverType getSolverType() const override { return solver_->getSolverType(); }

 private:
  btConstraintSolver* solver_;
  Probe probe_;
  Substep substep_;
  double time_ = 0;  ///< [ms]
};

}  // namespace cairn::bench
