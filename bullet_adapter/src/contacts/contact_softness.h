// SPDX-License-Identifier: MIT
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>

#include "cairn/bullet/options.h"
#include "cairn/bullet/precision.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// How a normal gives way.
struct Softness {
  btScalar erp = 0;         ///< Share of the penetration that a step takes away [1].
  btScalar compliance = 0;  ///< [1/kg]
  btScalar slop = 0;        ///< How deep the point rests [m].
};

/// The time step by which contacts rest: the shortest of late, so that a frame that hangs does not
/// let bodies sink.
class RestingStep {
 public:
  /// Of a substep of @p time_step [s].
  btScalar Next(btScalar time_step);
  void Forget() { step_ = 0; }

 private:
  btScalar step_ = 0;  ///< [s], 0 where there was none
};

/// How the contacts of a group give way: as the world says, gently where they have lasted long
/// (Options::resting_slop), or as a point says for itself.
class ContactSoftness {
 public:
  ContactSoftness() = default;
  /// @param resting_step  RestingStep::Next()
  ContactSoftness(const btContactSolverInfo& info, const Options& options, btScalar resting_step);

  /// Of the points of a manifold that have none of their own.
  Softness Of(const btPersistentManifold& manifold) const {
    return rests_ ? Rest(manifold) : world_;
  }
  /// Of a point.
  /// @param common  that of its manifold
  Softness Of(const btManifoldPoint& point, const Softness& common) const {
    constexpr int kOwn = BT_CONTACT_FLAG_HAS_CONTACT_CFM | BT_CONTACT_FLAG_HAS_CONTACT_ERP |
                         BT_CONTACT_FLAG_CONTACT_STIFFNESS_DAMPING;
    return (point.m_contactPointFlags & kOwn) != 0 ? Own(point) : common;
  }

 private:
  Softness Rest(const btPersistentManifold& manifold) const;
  Softness Own(const btManifoldPoint& point) const;

  btScalar time_step_ = 0, resting_step_ = 0, cfm_ = 0;
  Softness world_;
  bool rests_ = false;  ///< what lasts long is gentle
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
