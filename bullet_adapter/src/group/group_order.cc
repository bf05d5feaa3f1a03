// SPDX-License-Identifier: MIT
#include "group/group_order.h"

#include <algorithm>
#include <array>
#include <compare>

#include "cairn/detail/prefetch.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

/// Numbers that tell points of a manifold from those of another one between the same bodies: parts
/// of compound shapes, triangles, and what was found on the way of a fast body.
constexpr int kNumbers = 13;
std::array<btScalar, kNumbers> NumbersOf(const btManifoldPoint& point) {
  const btVector3 &a = point.m_localPointA, &b = point.m_localPointB, &n = point.m_normalWorldOnB;
  return {static_cast<btScalar>(point.m_partId0),
          static_cast<btScalar>(point.m_partId1),
          a.x(),
          a.y(),
          a.z(),
          b.x(),
          b.y(),
          b.z(),
          n.x(),
          n.y(),
          n.z(),
          point.m_distance1,
          point.m_appliedImpulse};
}

/// Whether one comes before another one of the same bodies, by what they hold. What is no number
/// comes first, so that any two are in order.
bool ComesBefore(const btPersistentManifold& a, const btPersistentManifold& b) {
  if (a.getNumContacts() != b.getNumContacts()) return a.getNumContacts() < b.getNumContacts();
  for (int i = 0; i < a.getNumContacts(); ++i) {
    const btManifoldPoint &of_a = a.getContactPoint(i), &of_b = b.getContactPoint(i);
    if (of_a.m_index0 != of_b.m_index0) return of_a.m_index0 < of_b.m_index0;
    if (of_a.m_index1 != of_b.m_index1) return of_a.m_index1 < of_b.m_index1;
    const auto numbers_a = NumbersOf(of_a), numbers_b = NumbersOf(of_b);
    for (int k = 0; k < kNumbers; ++k) {
      const std::strong_ordering order = std::strong_order(numbers_a[k], numbers_b[k]);
      if (order != 0) return order < 0;
    }
  }
  return false;
}

}  // namespace

template <class Part>
void GroupOrder::SortBy(const Part& part) {
  std::uint32_t most = 0;
  for (const Entry& entry : entries_) most = std::max(most, part(entry));
  begins_.assign(most + 2, 0);
  for (const Entry& entry : entries_) ++begins_[part(entry) + 1];
  for (std::uint32_t value = 0; value <= most; ++value) begins_[value + 1] += begins_[value];
  scratch_.resize(entries_.size());
  for (const Entry& entry : entries_) scratch_[begins_[part(entry)]++] = entry;
  entries_.swap(scratch_);
}

void GroupOrder::SortEntries() {
  SortBy([](const Entry& entry) { return entry.second; });
  SortBy([](const Entry& entry) { return entry.first; });
}

template <class Thing>
void GroupOrder::TakeEntries(std::vector<Thing*>* things) const {
  things->resize(entries_.size());
  for (size_t i = 0; i < entries_.size(); ++i) {
    (*things)[i] = static_cast<Thing*>(entries_[i].what);
  }
}

void GroupOrder::SortBodies(std::vector<btCollisionObject*>* bodies) {
  entries_.clear();
  for (btCollisionObject* body : *bodies) entries_.push_back({PlaceOf(*body), 0, body});
  SortBy([](const Entry& entry) { return entry.first; });
  TakeEntries(bodies);
}

void GroupOrder::SortManifolds(std::vector<btPersistentManifold*>* manifolds) {
  constexpr size_t kAhead = 16;
  entries_.clear();
  for (size_t i = 0; i < manifolds->size(); ++i) {
    if (i + kAhead < manifolds->size()) {
      Prefetch(&(*manifolds)[i + kAhead]->m_companionIdA - 4, 5 * sizeof(int));
    }
    btPersistentManifold* const manifold = (*manifolds)[i];
    if (manifold->getNumContacts() == 0) continue;
    entries_.push_back({PlaceOf(*manifold->getBody0()), PlaceOf(*manifold->getBody1()), manifold});
  }
  SortEntries();
  for (auto begin = entries_.begin(); begin != entries_.end();) {
    const auto end = std::find_if(begin, entries_.end(), [&](const Entry& entry) {
      return entry.first != begin->first || entry.second != begin->second;
    });
    if (end - begin > 1) {
      std::sort(begin, end, [](const Entry& a, const Entry& b) {
        return ComesBefore(*static_cast<btPersistentManifold*>(a.what),
                           *static_cast<btPersistentManifold*>(b.what));
      });
    }
    begin = end;
  }
  TakeEntries(manifolds);
}

void GroupOrder::SortJoints(std::vector<btTypedConstraint*>* joints) {
  entries_.clear();
  for (btTypedConstraint* joint : *joints) {
    entries_.push_back({PlaceOf(joint->getRigidBodyA()), PlaceOf(joint->getRigidBodyB()), joint});
  }
  SortEntries();
  TakeEntries(joints);
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
