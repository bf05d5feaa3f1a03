// SPDX-License-Identifier: MIT
// What the adapter promises of a substep; see world_game.h.
#include <cmath>
#include <limits>

#include "tests/fuzz/world_game.h"

namespace cairn::test {
namespace {

bool Finite(const btVector3& value) {
  return std::isfinite(value.x()) && std::isfinite(value.y()) && std::isfinite(value.z());
}

bool Finite(const btTransform& pose) {
  return Finite(pose.getOrigin()) && Finite(pose.getBasis()[0]) && Finite(pose.getBasis()[1]) &&
         Finite(pose.getBasis()[2]);
}

/// What a substep changes of a body.
bool FiniteMotion(const btRigidBody& body) {
  return Finite(body.getLinearVelocity()) && Finite(body.getAngularVelocity()) &&
         Finite(body.getWorldTransform());
}

/// What Bullet adds to the spin of a body that it turns, which for moments of inertia of 1e13 kg
/// m^2 on is none: their product is beyond floats.
btVector3 GyroscopicTerm(const btRigidBody& body, const btContactSolverInfo& info) {
  btVector3 term(0, 0, 0);
  const int flags = body.getFlags();
  if ((flags & BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT) != 0) {
    term += body.computeGyroscopicForceExplicit(info.m_maxGyroscopicForce);
  }
  if ((flags & BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD) != 0) {
    term += body.computeGyroscopicImpulseImplicit_World(info.m_timeStep);
  }
  if ((flags & BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY) != 0) {
    term += body.computeGyroscopicImpulseImplicit_Body(info.m_timeStep);
  }
  return term;
}

/// Whether what forces and gyroscopic terms add is a number, too.
bool FiniteInput(const btRigidBody& body, const btContactSolverInfo& info) {
  const btVector3 pushed = body.getTotalForce() * body.getInvMass() * info.m_timeStep;
  const btVector3 turned =
      body.getTotalTorque() * body.getInvInertiaTensorWorld() * info.m_timeStep;
  return FiniteMotion(body) && Finite(body.getLinearVelocity() + pushed) &&
         Finite(body.getAngularVelocity() + turned) && Finite(GyroscopicTerm(body, info));
}

bool AllFinite(std::span<btCollisionObject* const> bodies, const btContactSolverInfo& info) {
  for (const btCollisionObject* object : bodies) {
    const btRigidBody* const body = btRigidBody::upcast(object);
    if (body != nullptr && !FiniteInput(*body, info)) return false;
  }
  return std::isfinite(info.m_timeStep) && std::isfinite(info.m_splitImpulseTurnErp);
}

}  // namespace

void JudgedSolver::Break(const std::string& promise) {
  if (broken.empty()) broken = promise;
}

void JudgedSolver::prepareSolve(int bodies, int manifolds) {
  collecting_ = true;
  ConstraintSolver::prepareSolve(bodies, manifolds);
}

void JudgedSolver::allSolved(const btContactSolverInfo& info, btIDebugDraw* debug_drawer) {
  collecting_ = false;
  ConstraintSolver::allSolved(info, debug_drawer);
}

btScalar JudgedSolver::solveGroup(btCollisionObject** bodies, int num_bodies,
                                  btPersistentManifold** manifolds, int num_manifolds,
                                  btTypedConstraint** constraints, int num_constraints,
                                  const btContactSolverInfo& info, btIDebugDraw* debug_drawer,
                                  btDispatcher* dispatcher) {
  const std::span<btCollisionObject* const> objects(bodies, static_cast<size_t>(num_bodies));
  const std::span<btTypedConstraint* const> joints(constraints,
                                                   static_cast<size_t>(num_constraints));
  const bool was_finite = !collecting_ && AllFinite(objects, info);
  const btScalar result =
      ConstraintSolver::solveGroup(bodies, num_bodies, manifolds, num_manifolds, constraints,
                                   num_constraints, info, debug_drawer, dispatcher);
  if (!collecting_) Judge(objects, joints, was_finite);
  return result;
}

void JudgedSolver::Judge(std::span<btCollisionObject* const> bodies,
                         std::span<btTypedConstraint* const> joints, bool was_finite) {
  if (report().ok()) JudgeSolved(bodies, joints, was_finite);
  const bool is_solved = report().ok() && !fell_back();
  ++(is_solved ? solved : refused);
  if (must_solve && !is_solved)
    Break("plain numbers refused: " + std::string(Describe(report().status)));
}

void JudgedSolver::JudgeSolved(std::span<btCollisionObject* const> bodies,
                               std::span<btTypedConstraint* const> joints, bool was_finite) {
  double zero = 0 * (report().residual_max + report().residual_energy);
  for (const double impulse : impulses()) zero += 0 * impulse;
  if (zero != 0) Break("ok, and an impulse or residual is not finite");
  const bool fast = options().mode == bullet::Mode::kFast && !fell_back();
  if (was_finite && fast) {
    for (const btCollisionObject* object : bodies) {
      const btRigidBody* const body = btRigidBody::upcast(object);
      if (body != nullptr && !FiniteMotion(*body)) Break("ok, and a body is not finite");
    }
    for (btTypedConstraint* joint : joints) {
      if (!std::isfinite(joint->internalGetAppliedImpulse())) {
        Break("ok, and what a joint says of its impulse is not finite");
      }
    }
  }
  const Settings& asked = settings();
  if (asked.budget.kind() != Budget::Kind::kWork) return;
  // the sweeps that are made in any case, a block of rows, and a residual
  const double rows = static_cast<double>(impulses().size());
  const double most =
      static_cast<double>(asked.budget.work()) + rows * (2 * asked.tuning.min_sweeps + 3) + 64;
  if (static_cast<double>(report().work) > most) {
    Break("work of " + std::to_string(report().work) + " on a budget of " +
          std::to_string(asked.budget.work()) + " for " + std::to_string(rows) + " rows");
  }
}

}  // namespace cairn::test
