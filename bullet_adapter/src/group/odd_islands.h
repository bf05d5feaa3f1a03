// SPDX-License-Identifier: MIT
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <vector>

#include "cairn/bullet/precision.h"
#include "group/group.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// Cuts a group in two: islands with a joint of a type that Bullet does not ship, which may count
/// on what Bullet does around it, or with a contact that has bad numbers, and all others. Islands
/// are told by Bullet's tags.
class OddIslands {
 public:
  /// Both parts are good until the next call.
  /// @param bad  points with bad numbers
  /// @return  false if there is no such joint or point, nothing else to solve, or it is not known
  ///          what hangs on one
  bool Cut(const Group& group, std::span<const btManifoldPoint* const> bad);

  Group others() const { return others_.WithUnits(units_per_metre_); }
  Group odd() const { return odd_.WithUnits(units_per_metre_); }

 private:
  /// Notes the island of two objects; false if they are in none.
  bool Enter(const btCollisionObject& a, const btCollisionObject& b);
  bool IsOdd(int tag) const;
  bool IsOdd(const btCollisionObject& a, const btCollisionObject& b) const;

  double units_per_metre_ = 1;
  std::vector<int> tags_;  ///< of odd islands
  PartOfGroup others_, odd_;
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
