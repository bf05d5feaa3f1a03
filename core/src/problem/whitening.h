// SPDX-License-Identifier: MIT
#pragma once

#include "cairn/contact_problem.h"
#include "cairn/detail/eigen.h"

namespace cairn {

// Whitened velocities. With M^-1 = R R' per body, impulses x change velocities by R u, where
//
//   u = G' x,   G = J R,   and so   J M^-1 J' = G G',   kinetic energy of the change = |u|^2 / 2.
//
// One vector G per row serves as J and as M^-1 J', masses disappear from the formulas, and an axis
// that cannot move is a zero in G rather than a mass of infinity.

/// R of a body, and its velocity without constraints.
struct WhitenedBody {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< diagonal of the linear part of R
  Eigen::Matrix3d angular = Eigen::Matrix3d::Zero();  ///< angular part of R
  Velocity free;                                      ///< v_start + M^-1 external impulses
};

/// False if the body would not pass Validate(), which then says why.
bool Whiten(const Body& body, WhitenedBody* whitened);

/// How fast joints and contacts see a body move without impulses: as ContactProblem::motions says,
/// if there are any. Linear.
Eigen::Vector3d SeenFreeVelocity(const ContactProblem& problem, const WhitenedBody& whitened,
                                 int body);

/// How joints and contacts see a body spin without impulses, whitened: half its square is the
/// energy of that. Without what locks keep from changing.
Eigen::Vector3d WhitenedFreeSpin(const ContactProblem& problem, const WhitenedBody& whitened,
                                 int body);

/// The velocity that u changes a body to.
Velocity Unwhiten(const WhitenedBody& body, const Eigen::Vector3d& linear,
                  const Eigen::Vector3d& angular);

}  // namespace cairn
