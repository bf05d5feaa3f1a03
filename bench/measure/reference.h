// SPDX-License-Identifier: MIT
#pragma once

#include <btBulletDynamicsCommon.h>

#include <span>
#include <vector>

#include "cairn/contact_problem.h"
#include "cairn/settings.h"

namespace cairn::bench {

/// Settings of cairn::bullet::ConstraintSolver that make it the converged reference: it goes on
/// until the residual is below 1e-7 m/s, or as far as 20,000 sweeps with subspace steps among them
/// go. Report::residual_max says how good the reference itself is.
Settings ReferenceSettings();

/// Present velocities of bodies.
std::vector<Velocity> ReadVelocities(std::span<btRigidBody* const> bodies);

/// Largest difference of two sets of linear velocities [m/s]; infinity if one of them is NaN.
double VelocityError(std::span<const Velocity> a, std::span<const Velocity> b);

}  // namespace cairn::bench
