// SPDX-License-Identifier: MIT
#include "body_names.h"

#include <cstddef>

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

namespace {

// An explicit instantiation may name what is private ([temp.spec]/6), and hand it on by a friend.
using Number = int btRigidBody::*;
Number NumberMember();
template <Number member>
struct MemberOf {
  friend Number NumberMember() { return member; }
};
template struct MemberOf<&btRigidBody::m_debugBodyId>;

}  // namespace

int NumberOf(const btRigidBody& body) { return body.*NumberMember(); }

void BodyNames::BeginSubstep() {
  ++substep_;
  for (const int number : displaced_) {
    const auto found = by_number_.find(number);
    if (found == by_number_.end()) continue;
    if (places_[found->second.place].number != number) by_number_.erase(found);
  }
  displaced_.clear();
}

void BodyNames::Enter(int place, const btRigidBody& body) {
  const auto at = static_cast<std::size_t>(place);
  const int number = NumberOf(body);
  // what comes to the end of a world is new
  const bool at_end = at >= places_.size();
  if (at_end) places_.resize(at + 1);
  Place& there = places_[at];
  if (there.name != 0 && there.number != number) displaced_.push_back(there.number);
  const auto known = at_end ? by_number_.end() : by_number_.find(number);
  // Bullet counts without a lock: where worlds are made on several threads, two bodies may have one
  // number, and both are met in their first substep
  const bool was_here = known != by_number_.end() && known->second.since != substep_;
  there.name = was_here ? known->second.name
                        : (std::uint64_t{there.given++} << 32) | (std::uint64_t{at} + 1);
  there.number = number;
  by_number_.insert_or_assign(number, Named{there.name, place, substep_});
}

void BodyNames::Forget() {
  places_.clear();
  by_number_.clear();
  displaced_.clear();
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
