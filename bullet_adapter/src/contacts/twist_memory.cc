// SPDX-License-Identifier: MIT
#include "contacts/twist_memory.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

TwistMemory::Impulses TwistMemory::Find(const btManifoldPoint& point) {
  if (point.m_appliedImpulse == 0) return {};
  const int place = index_.Find(&point);
  if (place < 0 || entries_[place].normal_impulse != point.m_appliedImpulse) return {};
  return entries_[place].impulses;
}

void TwistMemory::Keep(const GroupProblem& group) {
  Forget();
  for (const PointRows& rows : group.points) {
    if (rows.twists == 0) continue;
    Impulses impulses{};
    for (int k = 0; k < rows.twists; ++k) {
      impulses[k] = static_cast<btScalar>(group.impulses[rows.twist_row + k]);
    }
    Keep(*rows.point, impulses);
  }
}

void TwistMemory::Keep(const btManifoldPoint& point, const Impulses& impulses) {
  if (point.m_appliedImpulse == 0) return;
  index_.Add(&point);
  entries_.push_back({point.m_appliedImpulse, impulses});
}

void TwistMemory::Forget() {
  index_.Clear();
  entries_.clear();
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
