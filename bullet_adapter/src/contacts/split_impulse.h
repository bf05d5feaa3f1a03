// SPDX-License-Identifier: MIT
#pragma once

#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>

#include <span>
#include <vector>

#include "body_table.h"
#include "cairn/bullet/precision.h"
#include "contacts/axes.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// A contact that is pushed out of deep penetration.
struct Push {
  int body_a, body_b;
  Axes axes;
  btScalar speed;       ///< Asked for [m/s], > 0.
  btScalar compliance;  ///< [1/kg]
};

/// How a body is displaced over a step, beside its velocity.
struct PushVelocity {
  btVector3 linear{0, 0, 0};   ///< [m/s]
  btVector3 angular{0, 0, 0};  ///< [rad/s]
};

/// Bullet's split impulse: sweeps of their own that move bodies apart and leave no speed behind.
class SplitImpulse {
 public:
  void Clear() { rows_.clear(); }
  void Add(const Push& push, btScalar over_relaxation, const BodyTable& bodies);

  /// Makes as many sweeps as the world has iterations, fewer if a sweep changes next to nothing
  /// (btContactSolverInfo::m_leastSquaresResidualThreshold).
  void Solve(const btContactSolverInfo& info, int bodies);

  /// By number of body after Solve(); empty if nothing is pushed.
  std::span<const PushVelocity> velocities() const { return velocities_; }

 private:
  struct PushRow {
    Push push;
    Response response_a, response_b;
    btScalar step;
    btScalar impulse;
  };

  /// Returns the change of relative velocity that the row asked for.
  btScalar Relax(PushRow* row);

  std::vector<PushRow> rows_;
  std::vector<PushVelocity> velocities_;
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
