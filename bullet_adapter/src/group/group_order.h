// SPDX-License-Identifier: MIT
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <cstdint>
#include <vector>

#include "cairn/bullet/precision.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// Bodies, manifolds and joints in an order that says nothing of who found them when: by the places
/// of their bodies in the world, then by what they hold. Time is linear in how many there are.
class GroupOrder {
 public:
  /// No body twice.
  void SortBodies(std::vector<btCollisionObject*>* bodies);
  /// Drops those without points, of which nothing is solved. Two that are equal in all that they
  /// hold may change places: one is as good as the other.
  void SortManifolds(std::vector<btPersistentManifold*>* manifolds);
  /// Joints of the same two bodies stay in their order, which is that of the world.
  void SortJoints(std::vector<btTypedConstraint*>* joints);

 private:
  struct Entry {
    std::uint32_t first, second;  ///< places in the world, plus one
    void* what;
  };

  static std::uint32_t PlaceOf(const btCollisionObject& object) {
    return static_cast<std::uint32_t>(object.getWorldArrayIndex() + 1);
  }
  /// By both places; equal ones keep their order.
  void SortEntries();
  template <class Part>
  void SortBy(const Part& part);
  template <class Thing>
  void TakeEntries(std::vector<Thing*>* things) const;

  std::vector<Entry> entries_, scratch_;
  std::vector<std::uint32_t> begins_;
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
