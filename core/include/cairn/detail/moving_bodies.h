// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <cstdint>
#include <span>

#include "cairn/contact_problem.h"
#include "cairn/detail/memory.h"

namespace cairn::detail {

/// The two bodies of a contact or joint, by what they are known by from frame to frame.
struct BodyPair {
  std::uint64_t a = 0, b = 0;  ///< BodyNameOf(); 0: the world
  int place_a = kWorld, place_b = kWorld;
};

/// Which bodies of a frame can move: others are asleep, not there, or never move.
class MovingBodies {
 public:
  explicit MovingBodies(Memory* memory = nullptr) : names_(memory) {}

  /// Throws std::bad_alloc, and then has changed nothing. The bodies are looked at until the next
  /// call of this.
  void Look(std::span<const Body> bodies);

  /// @param a, b  places, or kWorld; what is not there counts as the world
  BodyPair PairOf(int a, int b) const;
  /// One of them can. Bodies mostly keep their places.
  bool AnyOf(const BodyPair& pair) {
    return Has(pair.a, pair.place_a) || Has(pair.b, pair.place_b);
  }

 private:
  bool Has(std::uint64_t name, int place);

  std::span<const Body> bodies_;
  Array<std::uint64_t> names_;  ///< of those that can move, ascending, once somebody asks
  bool listed_ = false;
};

}  // namespace cairn::detail
