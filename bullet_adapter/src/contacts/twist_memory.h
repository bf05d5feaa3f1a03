// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "address_index.h"
#include "cairn/bullet/precision.h"
#include "group_problem.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// Impulses that resist rolling, from one solved group to the next: contact points have no place
/// for them. A point is the one that is remembered if it still has the normal impulse that it was
/// left with; a new one has none.
class TwistMemory {
 public:
  using Impulses = std::array<btScalar, 3>;  ///< [N m s]

  /// Begins a group.
  void Begin() { index_.Rewind(); }
  /// What a point ended with, zeros if it is not remembered.
  Impulses Find(const btManifoldPoint& point);
  /// Remembers the rows of a solved group, once its impulses are written to the points.
  void Keep(const GroupProblem& group);
  /// Remembers one more point, likewise.
  void Keep(const btManifoldPoint& point, const Impulses& impulses);
  void Forget();

 private:
  struct Entry {
    btScalar normal_impulse;
    Impulses impulses;
  };

  AddressIndex index_;
  std::vector<Entry> entries_;
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
