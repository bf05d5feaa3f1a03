// SPDX-License-Identifier: MIT
#include "body_names.h"

#include <algorithm>
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

void BodyNames::Enter(int place, const btRigidBody& body) {
  const auto at = static_cast<std::size_t>(place);
  // what comes to the end of a world is new
  const bool at_end = at >= places_.size();
  if (at_end) places_.resize(at + 1);
  std::uint64_t name = at_end ? 0 : NameBefore(NumberOf(body));
  Place& there = places_[at];
  if (name == 0) name = (std::uint64_t{there.given++} << 32) | (static_cast<std::uint64_t>(at) + 1);
  there.name = name;
  there.number = NumberOf(body);
}

void BodyNames::Forget() {
  places_.clear();
  listed_ = false;
}

std::uint64_t BodyNames::NameBefore(int number) {
  if (!std::exchange(listed_, true)) {
    before_.clear();
    for (const Place& place : places_) {
      if (place.name != 0) before_.emplace_back(place.number, place.name);
    }
    std::sort(before_.begin(), before_.end());
  }
  const auto found = std::lower_bound(before_.begin(), before_.end(), Named(number, 0));
  return found != before_.end() && found->first == number ? found->second : 0;
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
