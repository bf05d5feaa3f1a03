// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "cairn/detail/memory.h"
#include "runtime/crew.h"

namespace cairn {

/// The place of a pair in a sweep: by group, then colour, then what its rows look like.
struct PairKey {
  int group, colour, shape;
  friend auto operator<=>(const PairKey&, const PairKey&) = default;
};

/// How many there are of each part of a key.
struct PairKeyCounts {
  int groups, colours, shapes;
};

/// Pairs in the order of their keys, kept from call to call: a pair that begins, or whose key has
/// changed, goes behind all others of its key, and no other pair is touched. Where too many have
/// changed all are sorted, and pairs of one key are in the order of the list.
class PairOrder {
 public:
  /// Room for the keys of so many pairs, to be filled.
  std::span<PairKey> Begin(int pairs);
  /// @p before: where each pair was in the list of the last call, -1 if it is new; each place at
  /// most once.
  void End(std::span<const int> before, const PairKeyCounts& counts, Crew* crew);
  /// Places in the list.
  std::span<const int> order() const { return order_; }

 private:
  void SortAll(const PairKeyCounts& counts);
  void FindMoved(std::span<const int> before, Crew* crew);
  void MoveSome(Crew* crew);
  template <class Part>
  void SortBy(int values, const Part& part);

  Array<PairKey> keys_, last_keys_;
  Array<int> order_, scratch_, counts_;
  Array<int> moved_;  ///< places in the list, of pairs that are new or have another key
  Array<int> kept_;   ///< by place in the last list: that in the new one, -1 if not kept
  /// Of the pairs that one thread looks at.
  struct Share {
    int count = 0;  ///< that are moved, or kept, or kept before these
    int last = -1;  ///< that is kept, or was before these; -1: none
  };
  Array<Share> shares_;
};

}  // namespace cairn
