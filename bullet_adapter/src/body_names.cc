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
  std::uint64_t name = known == by_number_.end() ? 0 : known->second.name;
  if (name == 0) name = (std::uint64_t{there.given++} << 32) | (static_cast<std::uint64_t>(at) + 1);
  there.name = name;
  there.number = number;
  by_number_.insert_or_assign(number, Named{name, place});
}

void BodyNames::Forget() {
  places_ = {};
  by_number_ = {};
  displaced_ = {};
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
