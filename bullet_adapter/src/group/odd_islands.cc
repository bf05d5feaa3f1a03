// SPDX-License-Identifier: MIT
#include "group/odd_islands.h"

#include <algorithm>

#include "joint_rows.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

bool OddIslands::IsOdd(int tag) const {
  return tag >= 0 && std::find(tags_.begin(), tags_.end(), tag) != tags_.end();
}

bool OddIslands::IsOdd(const btCollisionObject& a, const btCollisionObject& b) const {
  return IsOdd(a.getIslandTag()) || IsOdd(b.getIslandTag());
}

bool OddIslands::Enter(const btCollisionObject& a, const btCollisionObject& b) {
  // what cannot move has none
  const int tag = std::max(a.getIslandTag(), b.getIslandTag());
  if (tag >= 0 && !IsOdd(tag)) tags_.push_back(tag);
  return tag >= 0;
}

bool OddIslands::Cut(const Group& group, std::span<const btManifoldPoint* const> bad) {
  tags_.clear();
  for (const btTypedConstraint* const joint : group.joints) {
    if (IsOfKnownType(*joint)) continue;
    if (!Enter(joint->getRigidBodyA(), joint->getRigidBodyB())) return false;
  }
  const auto has_bad_point = [&](const btPersistentManifold& manifold) {
    for (int i = 0; i < manifold.getNumContacts(); ++i) {
      if (std::find(bad.begin(), bad.end(), &manifold.getContactPoint(i)) != bad.end()) return true;
    }
    return false;
  };
  for (const btPersistentManifold* const manifold : group.manifolds) {
    if (bad.empty() || !has_bad_point(*manifold)) continue;
    if (!Enter(*manifold->getBody0(), *manifold->getBody1())) return false;
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
