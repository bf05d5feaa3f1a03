// SPDX-License-Identifier: MIT
#include "group/odd_islands.h"

#include <algorithm>

#include "joint_rows.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

void OddIslands::Part::Clear() {
  bodies.clear();
  manifolds.clear();
  joints.clear();
}

bool OddIslands::IsOdd(int tag) const {
  return tag >= 0 && std::find(tags_.begin(), tags_.end(), tag) != tags_.end();
}

bool OddIslands::IsOdd(const btCollisionObject& a, const btCollisionObject& b) const {
  return IsOdd(a.getIslandTag()) || IsOdd(b.getIslandTag());
}

bool OddIslands::Cut(const Group& group) {
  tags_.clear();
  for (const btTypedConstraint* const joint : group.joints) {
    if (IsOfKnownType(*joint)) continue;
    // what cannot move has none
    const int tag =
        std::max(joint->getRigidBodyA().getIslandTag(), joint->getRigidBodyB().getIslandTag());
    if (tag < 0) return false;
    if (!IsOdd(tag)) tags_.push_back(tag);
  }
  if (tags_.empty()) return false;
  units_per_metre_ = group.units_per_metre;
  others_.Clear();
  odd_.Clear();
  for (btCollisionObject* const body : group.bodies) {
    (IsOdd(body->getIslandTag()) ? odd_ : others_).bodies.push_back(body);
  }
  for (btPersistentManifold* const manifold : group.manifolds) {
    const bool odd = IsOdd(*manifold->getBody0(), *manifold->getBody1());
    (odd ? odd_ : others_).manifolds.push_back(manifold);
  }
  for (btTypedConstraint* const joint : group.joints) {
    const bool odd = IsOdd(joint->getRigidBodyA(), joint->getRigidBodyB());
    (odd ? odd_ : others_).joints.push_back(joint);
  }
  return !others_.manifolds.empty() || !others_.joints.empty();
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
