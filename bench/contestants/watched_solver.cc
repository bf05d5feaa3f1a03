// SPDX-License-Identifier: MIT
#include "contestants/watched_solver.h"

#include <fmt/format.h>

#include <cmath>

namespace cairn::cli {
namespace {

bool IsFinite(const btVector3& v) {
  return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
}

bool IsFinite(const btRigidBody& body) {
  return IsFinite(body.getLinearVelocity()) && IsFinite(body.getAngularVelocity()) &&
         IsFinite(body.getWorldTransform().getOrigin());
}

/// What is wrong with the body; empty if nothing is.
std::string Fault(const btRigidBody& body) {
  if (!IsFinite(body)) return "a velocity is not a number";
  const btScalar speed = body.getLinearVelocity().length();
  if (speed <= WatchedSolver::kMostSpeed) return "";
  return fmt::format("exploded: a body moves at {:.1e} m/s", speed);
}

void Stop(btRigidBody* body) {
  body->setLinearVelocity(btVector3(0, 0, 0));
  body->setAngularVelocity(btVector3(0, 0, 0));
  if (!IsFinite(body->getWorldTransform().getOrigin())) {
    body->setWorldTransform(body->getInterpolationWorldTransform());
  }
}

}  // namespace

void WatchedSolver::allSolved(const btContactSolverInfo& info, btIDebugDraw* debug_drawer) {
  InstrumentedSolver::allSolved(info, debug_drawer);
  if (world_ == nullptr || !failure_.empty()) return;
  const btAlignedObjectArray<btRigidBody*>& bodies = world_->getNonStaticRigidBodies();
  for (int i = 0; i < bodies.size() && failure_.empty(); ++i) {
    failure_ = Fault(*bodies[i]);
    not_a_number_ = !IsFinite(*bodies[i]);
  }
  if (failure_.empty()) return;
  for (int i = 0; i < bodies.size(); ++i) Stop(bodies[i]);
}

}  // namespace cairn::cli
