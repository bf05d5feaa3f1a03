// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "cairn/contact_problem.h"
#include "cairn/detail/eigen.h"

namespace cairn::bench {

/// M^-1 times momenta.
Velocity Respond(const Body& body, const Eigen::Vector3d& linear, const Eigen::Vector3d& angular);

/// Velocities with external impulses and without any row, one per body.
std::vector<Velocity> FreeVelocities(std::span<const Body> bodies);

/// J v of a row; velocities of bodies that are not there are 0.
double RowSpeed(const Row& row, std::span<const Velocity> velocities);

/// Adds M^-1 J' x of the rows, @p impulses x.
void Push(const ContactProblem& problem, std::span<const double> impulses,
          std::span<Velocity> velocities);

}  // namespace cairn::bench
