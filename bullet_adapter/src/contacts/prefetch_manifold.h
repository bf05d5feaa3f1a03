// SPDX-License-Identifier: MIT
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <span>

#include "cairn/bullet/precision.h"
#include "cairn/detail/prefetch.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// Before it is asked what is known of an object.
inline void PrefetchObject(const btCollisionObject& object) {
  const auto* const begin = reinterpret_cast<const char*>(&object);
  Prefetch(begin + 64);   // where it is
  Prefetch(begin + 192);  // its friction, and its index in the world
}

enum class PrefetchPoints { kNo, kYes };

/// Manifolds lie all over the memory, and most of a large world are empty: how many points they
/// have is asked for some ahead, their bodies and, if wanted, their points a little ahead.
inline void PrefetchAhead(std::span<btPersistentManifold* const> manifolds, size_t i,
                          PrefetchPoints points = PrefetchPoints::kNo) {
  constexpr size_t kFar = 32, kNear = 8;
  if (i + kFar < manifolds.size()) {
    // the number of points is a little before it, maybe in another line
    Prefetch(&manifolds[i + kFar]->m_companionIdA - 4, 5 * sizeof(int));
  }
  if (i + kNear >= manifolds.size()) return;
  const btPersistentManifold& near = *manifolds[i + kNear];
  if (near.getNumContacts() == 0) return;
  PrefetchObject(*near.getBody0());
  PrefetchObject(*near.getBody1());
  if (points == PrefetchPoints::kNo) return;
  Prefetch(&near.getContactPoint(0), near.getNumContacts() * sizeof(btManifoldPoint));
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
