// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>

#include <memory>

#include "cairn/bullet/constraint_solver.h"
#include "cairn/bullet/options.h"
#include "cairn/bullet/precision.h"
#include "cairn/settings.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// What a btDiscreteDynamicsWorldMt asks for as its pool of solvers: one ConstraintSolver behind a
/// door for many threads. Groups may come from any thread between prepareSolve() and allSolved();
/// they are collected, and solved as one problem, on Settings::threads threads. Pass no solver for
/// large islands beside it: this one is for all.
///
/// Bullet finds contacts on many threads, and the order in which it comes to know them depends on
/// who was first. Here bodies, manifolds and joints are put into an order that does not: by the
/// places of their bodies in the world, then by what they hold. The same bits for any number of
/// threads follow from that; they are not those of a btDiscreteDynamicsWorld, which has its own
/// order.
///
/// A group that comes outside of the two calls is solved at once, one at a time.
class ConstraintSolverPool : public btConstraintSolverPoolMt {
 public:
  explicit ConstraintSolverPool(const Settings& settings = {}, const Options& options = {});
  ~ConstraintSolverPool() override;

  /// Settings, options, report and the rest. It keeps its place as long as the pool lives.
  ConstraintSolver& solver();
  Settings& settings() { return solver().settings(); }
  const Report& report() { return solver().report(); }

  void prepareSolve(int bodies, int manifolds) override;
  btScalar solveGroup(btCollisionObject** bodies, int num_bodies, btPersistentManifold** manifolds,
                      int num_manifolds, btTypedConstraint** constraints, int num_constraints,
                      const btContactSolverInfo& info, btIDebugDraw* debug_drawer,
                      btDispatcher* dispatcher) override;
  void allSolved(const btContactSolverInfo& info, btIDebugDraw* debug_drawer) override;
  void reset() override;
  btConstraintSolverType getSolverType() const override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
