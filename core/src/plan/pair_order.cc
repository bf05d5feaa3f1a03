// SPDX-License-Identifier: MIT
#include "plan/pair_order.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "plan/pairs.h"
#include "runtime/in_parts.h"

namespace cairn {
namespace {

/// Moving single pairs pays while fewer than one in so many has moved.
constexpr size_t kShareOfMoved = 8;

}  // namespace

std::span<PairKey> PairOrder::Begin(int pairs) {
  keys_.swap(last_keys_);
  keys_.resize(pairs);
  return keys_;
}

void PairOrder::End(std::span<const int> before, const PairKeyCounts& counts, Crew* crew) {
  FindMoved(before, crew);
  if (moved_.size() > keys_.size() / kShareOfMoved) {
    SortAll(counts);
  } else {
    MoveSome(crew);
  }
}

void PairOrder::FindMoved(std::span<const int> before, Crew* crew) {
  const int pairs = static_cast<int>(keys_.size());
  kept_.assign(last_keys_.size(), -1);
  moved_.resize(keys_.size());
  shares_.assign((pairs + kPairsOfPart - 1) / kPairsOfPart, {});
  InParts(pairs, kPairsOfPart, crew, [&](int first, int count) {
    int moved = first;
    for (int i = first; i < first + count; ++i) {
      if (before[i] >= 0 && last_keys_[before[i]] == keys_[i]) {
        kept_[before[i]] = i;
      } else {
        moved_[moved++] = i;
      }
    }
    shares_[first / kPairsOfPart].count = moved - first;
  });
  int moved = 0;
  for (int share = 0; share < static_cast<int>(shares_.size()); ++share) {
    const auto begin = moved_.begin() + share * kPairsOfPart;
    const auto to = moved_.begin() + moved;
    if (to != begin) std::copy(begin, begin + shares_[share].count, to);
    moved += shares_[share].count;
  }
  moved_.resize(moved);
}

void PairOrder::MoveSome(Crew* crew) {
  const auto earlier = [this](int i, int j) {
    return keys_[i] != keys_[j] ? keys_[i] < keys_[j] : i < j;
  };
  std::sort(moved_.begin(), moved_.end(), earlier);

  const int pairs = static_cast<int>(order_.size());
  shares_.assign((pairs + kPairsOfPart - 1) / kPairsOfPart, {});
  InParts(pairs, kPairsOfPart, crew, [&](int first, int count) {
    Share& share = shares_[first / kPairsOfPart];
    for (const int last : std::span(order_).subspan(first, count)) {
      if (kept_[last] < 0) continue;
      ++share.count;
      share.last = kept_[last];
    }
  });
  // where each part begins, and behind which pair
  int kept = 0, last_kept = -1;
  for (Share& share : shares_) {
    const Share own = std::exchange(share, {kept, last_kept});
    kept += own.count;
    if (own.last >= 0) last_kept = own.last;
  }
  scratch_.resize(keys_.size());
  const auto moved_before = [this](int pair) {
    if (pair < 0) return moved_.begin();
    return std::lower_bound(moved_.begin(), moved_.end(), pair,
                            [this](int i, int of) { return keys_[i] < keys_[of]; });
  };
  InParts(pairs, kPairsOfPart, crew, [&](int first, int count) {
    const Share& share = shares_[first / kPairsOfPart];
    auto moved = moved_before(share.last);
    auto to = scratch_.begin() + share.count + (moved - moved_.begin());
    for (const int last : std::span(order_).subspan(first, count)) {
      const int pair = kept_[last];
      if (pair < 0) continue;
      while (moved != moved_.end() && keys_[*moved] < keys_[pair]) *to++ = *moved++;
      *to++ = pair;
    }
  });
  const auto rest = moved_before(last_kept);
  std::copy(rest, moved_.end(), scratch_.begin() + kept + (rest - moved_.begin()));
  order_.swap(scratch_);
}

void PairOrder::SortAll(const PairKeyCounts& counts) {
  order_.resize(keys_.size());
  std::iota(order_.begin(), order_.end(), 0);
  SortBy(counts.shapes, [this](int i) { return keys_[i].shape; });
  SortBy(counts.colours, [this](int i) { return keys_[i].colour; });
  SortBy(counts.groups, [this](int i) { return keys_[i].group; });
}

template <class Part>
void PairOrder::SortBy(int values, const Part& part) {
  counts_.assign(values + 1, 0);
  for (int pair : order_) ++counts_[part(pair) + 1];
  for (int k = 0; k < values; ++k) counts_[k + 1] += counts_[k];
  scratch_.resize(order_.size());
  for (int pair : order_) scratch_[counts_[part(pair)]++] = pair;
  order_.swap(scratch_);
}

}  // namespace cairn
