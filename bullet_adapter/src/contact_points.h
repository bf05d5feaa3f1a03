// SPDX-License-Identifier: MIT
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>

#include <span>
#include <vector>

#include "body_table.h"
#include "cairn/bullet/group_rows.h"
#include "cairn/bullet/precision.h"
#include "cairn/contact_problem.h"
#include "contact_input.h"
#include "split_impulse.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// The contacts of a group that the core takes as manifolds, with nothing written out as rows: all
/// that are neither anisotropic nor anchored, and whose directions of friction no user has set. The
/// formulas are those of ContactRowBuilder, in the kernels of the core.
class ContactPoints {
 public:
  /// Begins a group.
  void Begin(const btContactSolverInfo& info, SweepLimits limits, const ContactStart& start);
  /// Ends it: no manifold follows.
  void End();
  /// Appends a manifold, and its deep penetration to @p pushes. False if it has to be written out
  /// as rows: nothing was done.
  bool Append(btPersistentManifold* manifold, BodyTable* bodies, SplitImpulse* pushes);

  std::span<const Manifold> manifolds() const { return manifolds_; }
  std::span<const ContactPoint> points() const { return points_; }
  /// One per point: the start, and after solving the result.
  std::span<ContactImpulse> impulses() { return impulses_; }
  std::span<const ContactImpulse> impulses() const { return impulses_; }
  /// One per point, or none if nothing rolls.
  std::span<const ContactTwist> twists() const { return twists_; }
  std::span<TwistImpulse> twist_impulses() { return twist_impulses_; }
  std::span<const TwistImpulse> twist_impulses() const { return twist_impulses_; }
  cairn::ContactLaw law() const { return law_; }
  /// Bullet's, one per point.
  std::span<btManifoldPoint* const> sources() const { return sources_; }

  /// Writes impulses and directions to the points of Bullet.
  void Write() const;
  /// Adds what resists rolling to @p memory, once everything is written.
  void Keep(TwistMemory* memory) const;

 private:
  /// Whether a manifold can be taken, and with what.
  enum class Kind { kNotTaken, kPlain, kRolling };
  Kind KindOf(const btPersistentManifold& manifold) const;
  bool IsPlain(const btManifoldPoint& point) const;
  struct Ends {
    int body_a, body_b;
    const btVector3 &origin_a, &origin_b;
  };
  bool IsPushed(const btManifoldPoint& point) const;
  void AppendPoint(const Ends& ends, btManifoldPoint* source);
  /// What resists rolling at the last point.
  void AddTwist(const btManifoldPoint& source);
  void AddPush(const Ends& ends, const btManifoldPoint& point, const BodyTable& bodies,
               SplitImpulse* pushes);

  btContactSolverInfo info_;
  bool takes_any_ = false;  ///< the settings of the group allow it
  ContactStart start_;
  cairn::ContactLaw law_;
  Manifold like_;  ///< what all manifolds have in common
  std::vector<Manifold> manifolds_;
  std::vector<ContactPoint> points_;
  std::vector<ContactImpulse> impulses_;
  std::vector<ContactTwist> twists_;  ///< as many as there are points up to the last that rolls
  std::vector<TwistImpulse> twist_impulses_;
  std::vector<btManifoldPoint*> sources_;
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
