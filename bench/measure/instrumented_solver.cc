// SPDX-License-Identifier: MIT
#include "measure/instrumented_solver.h"

#include <cmath>

#include "support/machine/stopwatch.h"

namespace cairn::bench {
namespace {

constexpr cli::SolverClock kClock = cli::SolverClock::kWall;

}  // namespace

std::chrono::nanoseconds InstrumentedSolver::TakeTime() {
  return std::chrono::nanoseconds(std::llround(1e6 * std::exchange(time_, 0)));
}

void InstrumentedSolver::prepareSolve(int num_bodies, int num_manifolds) {
  if (probe_) {
    substep_.Begin(num_bodies, num_manifolds);
    return;
  }
  const cli::SummedTime summed(kClock, &time_);
  solver_->prepareSolve(num_bodies, num_manifolds);
}

btScalar InstrumentedSolver::solveGroup(btCollisionObject** bodies, int num_bodies,
                                        btPersistentManifold** manifolds, int num_manifolds,
                                        btTypedConstraint** joints, int num_joints,
                                        const btContactSolverInfo& info, btIDebugDraw* debug_drawer,
                                        btDispatcher* dispatcher) {
  if (probe_) {
    substep_.Add({.bodies = {bodies, bodies + num_bodies},
                  .manifolds = {manifolds, manifolds + num_manifolds},
                  .joints = {joints, joints + num_joints}},
                 dispatcher);
    return 0;
  }
  const cli::SummedTime summed(kClock, &time_);
  return solver_->solveGroup(bodies, num_bodies, manifolds, num_manifolds, joints, num_joints, info,
                             debug_drawer, dispatcher);
}

void InstrumentedSolver::allSolved(const btContactSolverInfo& info, btIDebugDraw* debug_drawer) {
  if (probe_) {
    substep_.Capture();
    std::exchange(probe_, nullptr)(&substep_, info);
    substep_.Restore();
    const cli::SummedTime summed(kClock, &time_);
    substep_.SolveWith(solver_, info, debug_drawer);
    return;
  }
  const cli::SummedTime summed(kClock, &time_);
  solver_->allSolved(info, debug_drawer);
}

}  // namespace cairn::bench
