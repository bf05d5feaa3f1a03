// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cairn/detail/memory.h"
#include "cairn/detail/moving_bodies.h"

namespace cairn::detail {

/// What contacts or joints of the last frame exerted, for those of the next one to start from. What
/// is left out of a frame is forgotten, unless none of its bodies can move in it: those are asleep,
/// without mass or not there, and start from what they exerted before when they are back.
class StartMemory {
 public:
  /// What a point or joint is known by; an id of 0 is no name.
  struct Key {
    std::uint64_t id;
    std::uint32_t feature;
    friend auto operator<=>(const Key&, const Key&) = default;
  };

  explicit StartMemory(Memory* memory = nullptr);

  /// What one of them exerted, and what share of it to start from; nullptr: not known.
  struct Start {
    const float* impulses = nullptr;
    float share = 1;
  };

  /// Begins a frame. Throws std::bad_alloc, and then has changed nothing that counts.
  /// @param impulses   that the last frame exerted, in the order of Add()
  /// @param bodies     looked at until the last Add()
  /// @param time_step  of the frame [s]
  void Begin(std::span<const float> impulses, std::span<const Body> bodies, double time_step);
  /// Makes room for so many more Add(). Throws std::bad_alloc.
  void Reserve(std::size_t more);
  /// Enters a contact or joint of so many impulses between two bodies, by their places.
  Start Add(const Key& key, int body_a, int body_b, int count);

 private:
  struct Entry {
    Key key;
    int first, count;  ///< of its impulses
    BodyPair bodies;
    bool moves;        ///< one of its bodies can
    double time_step;  ///< [s]
  };
  static bool IsBefore(const Entry& a, const Entry& b) {
    return a.key != b.key ? a.key < b.key : a.first < b.first;
  }

  void KeepLast(std::span<const float> impulses);
  void WakeUp();
  void SortAsleep();
  Start Find(const Array<Entry>& entries, const Array<float>& impulses, const Key& key,
             int count) const;

  MovingBodies moving_;
  Array<Entry> added_;   ///< in this frame
  Array<Entry> kept_;    ///< those of the last frame, and those that wake in this one, by key
  Array<Entry> asleep_;  ///< by key
  Array<float> kept_impulses_, asleep_impulses_, spare_;
  int end_ = 0;           ///< of the impulses of added_
  double time_step_ = 0;  ///< of this frame [s]
};

}  // namespace cairn::detail
