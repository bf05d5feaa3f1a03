// SPDX-License-Identifier: MIT
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>

#include <span>
#include <vector>

#include "body_table.h"
#include "cairn/bullet/detail/group_rows.h"
#include "cairn/bullet/precision.h"
#include "cairn/contact_problem.h"
#include "cairn/detail/threads.h"
#include "contacts/contact_input.h"
#include "contacts/split_impulse.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// The contacts of a group that the core takes as manifolds, with nothing written out as rows: all
/// that are neither anisotropic nor anchored, and whose directions of friction no user has set. The
/// formulas are those of ContactRowBuilder, in the kernels of the core.
class ContactPoints {
 public:
  /// Begins a group.
  void Begin(const btContactSolverInfo& info, SweepLimits limits, FrictionBounds bounds,
             const ContactSoftness& softness, const ContactStart& start);
  /// Ends it: no manifold follows.
  void End();
  /// Appends a manifold, and its deep penetration to @p pushes. False if it has to be written out
  /// as rows: nothing was done.
  bool Append(btPersistentManifold* manifold, BodyTable* bodies, SplitImpulse* pushes);
  /// Appends all manifolds of a group on several threads, with the result of Append() one by one.
  /// False if some have to be written out as rows: nothing was done.
  bool AppendAll(std::span<btPersistentManifold* const> manifolds, BodyTable* bodies,
                 SplitImpulse* pushes, detail::Threads* threads);

  std::span<const Manifold> manifolds() const {
    return std::span(manifolds_).first(manifold_count_);
  }
  std::span<const ContactPoint> points() const { return std::span(points_).first(count_); }
  /// One per point: the start, and after solving the result.
  std::span<ContactImpulse> impulses() { return std::span(impulses_).first(count_); }
  /// One per point, or none if nothing rolls.
  std::span<const ContactTwist> twists() const { return twists_; }
  std::span<TwistImpulse> twist_impulses() { return twist_impulses_; }
  cairn::ContactLaw law() const { return law_; }
  /// Bullet's, one per point.
  std::span<btManifoldPoint* const> sources() const { return std::span(sources_).first(count_); }

  /// Writes impulses and directions to the points of Bullet.
  void Write(detail::Threads* threads) const;
  /// Adds what resists rolling to @p memory, once everything is written.
  void Keep(TwistMemory* memory) const;

 private:
  struct Ends {
    ContactEnd a, b;
  };
  /// A manifold with points, and whom it is between; nullptr for one who was not met yet.
  struct Entry {
    btPersistentManifold* manifold;
    const ContactEnd *a, *b;
  };
  /// What cannot be done on several threads.
  struct Rest {
    int manifold;
    Entry entry;
    bool pushed, rolls;
  };
  /// Manifolds of a group that one thread reads.
  struct Part {
    std::vector<Entry> entries;
    std::vector<Rest> rest;
    int points = 0, first_point = 0, first_manifold = 0;
    bool strange = false;      ///< some are with somebody who was not met yet
    bool written_out = false;  ///< some have to be
  };
  /// What there is among the points of a manifold.
  struct Features {
    int points = 0;  ///< that count
    int flags = 0;   ///< of any
    bool pushed = false, rolls = false, soft = false;
  };

  void MakeRoom(size_t more);
  /// Reads the points of a manifold into a place where there is room for them.
  Features ReadPoints(const Ends& ends, btPersistentManifold* manifold, size_t place);
  /// Whether a manifold can stay one.
  bool Takes(const Ends& ends, const Features& found) const;
  void Describe(const Ends& ends, const Features& found, size_t first_point, Manifold* to) const;
  void FindEntries(std::span<btPersistentManifold* const> manifolds, const BodyTable& bodies,
                   Part* part) const;
  /// Enters who was not met yet. Whether pointers of entries are good no longer: some moved.
  static bool EnterStrangers(std::span<const Part> parts, BodyTable* bodies);
  /// Points to those, and drops manifolds in which nobody reacts.
  void MeetStrangers(BodyTable* bodies, Part* part) const;
  void ReadPart(Part* part);
  void ReadRest(const Part& part, const BodyTable& bodies, SplitImpulse* pushes);
  /// @param softness  of the point
  void ReadPoint(const Ends& ends, const btManifoldPoint& source, const Softness& softness,
                 size_t place, Features* found);
  bool IsPushed(btScalar distance) const;
  void WritePart(size_t first, size_t end) const;
  /// What resists rolling at a point.
  void AddTwist(size_t place);
  /// Adds what takes a deep point of a manifold apart to @p pushes.
  void AddPush(const Ends& ends, const btPersistentManifold& manifold, const btManifoldPoint& point,
               const BodyTable& bodies, SplitImpulse* pushes);

  btContactSolverInfo info_;
  bool takes_any_ = false;  ///< the settings of the group allow it
  int not_taken_ = 0;       ///< flags of points that have to be written out
  ContactSoftness softness_;
  ContactStart start_;
  cairn::ContactLaw law_;
  Manifold like_;  ///< what all manifolds have in common
  std::vector<Part> parts_;
  int in_order_ = 0;  ///< groups to be read one by one, as one of late had to be
  // of the manifolds and points, the first are in use
  size_t manifold_count_ = 0;
  std::vector<Manifold> manifolds_;
  size_t count_ = 0;
  std::vector<ContactPoint> points_;
  std::vector<ContactImpulse> impulses_;
  std::vector<btManifoldPoint*> sources_;
  std::vector<ContactTwist> twists_;  ///< as many as there are points up to the last that rolls
  std::vector<TwistImpulse> twist_impulses_;
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
