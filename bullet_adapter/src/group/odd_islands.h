// SPDX-License-Identifier: MIT
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <vector>

#include "cairn/bullet/precision.h"
#include "group/group.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// Cuts a group in two: islands with a joint of a type that Bullet does not ship, which may count
/// on what Bullet does around it, and all others. Islands are told by Bullet's tags.
class OddIslands {
 public:
  /// Both parts are good until the next call.
  /// @return  false if there is no such joint, nothing else to solve, or it is not known what
  ///          hangs on one
  bool Cut(const Group& group);

  Group others() const { return others_.group(units_per_metre_); }
  Group odd() const { return odd_.group(units_per_metre_); }

 private:
  struct Part {
    std::vector<btCollisionObject*> bodies;
    std::vector<btPersistentManifold*> manifolds;
    std::vector<btTypedConstraint*> joints;

    Group group(double units_per_metre) const {
      return {bodies, manifolds, joints, units_per_metre};
    }
    void Clear();
  };

  bool IsOdd(int tag) const;
  bool IsOdd(const btCollisionObject& a, const btCollisionObject& b) const;

  double units_per_metre_ = 1;
  std::vector<int> tags_;  ///< of odd islands
  Part others_, odd_;
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
