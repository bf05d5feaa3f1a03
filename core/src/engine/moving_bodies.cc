// SPDX-License-Identifier: MIT
#include "cairn/detail/moving_bodies.h"

#include <algorithm>
#include <cstddef>

#include "problem/body_name.h"
#include "problem/islands.h"

namespace cairn::detail {

void MovingBodies::Look(std::span<const Body> bodies) {
  names_.reserve(bodies.size());
  names_.clear();
  listed_ = false;
  bodies_ = bodies;
}

BodyPair MovingBodies::PairOf(int a, int b) const {
  const auto name = [this](int place) -> std::uint64_t {
    return place == kWorld ? 0 : BodyNameOf(bodies_[static_cast<std::size_t>(place)], place);
  };
  return {.a = name(a), .b = name(b), .place_a = a, .place_b = b};
}

bool MovingBodies::Has(std::uint64_t name, int place) {
  if (name == 0) return false;
  const auto at = static_cast<std::size_t>(place);
  if (at < bodies_.size() && BodyNameOf(bodies_[at], place) == name) return CanMove(bodies_[at]);
  if (!listed_) {
    listed_ = true;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (CanMove(bodies_[i])) names_.push_back(BodyNameOf(bodies_[i], static_cast<int>(i)));
    }
    std::sort(names_.begin(), names_.end());
  }
  return std::binary_search(names_.begin(), names_.end(), name);
}

}  // namespace cairn::detail
