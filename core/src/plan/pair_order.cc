// SPDX-License-Identifier: MIT
#include "plan/pair_order.h"

#include <algorithm>
#include <numeric>

namespace cairn {
namespace {

/// Moving single pairs pays while fewer than one in so many has moved.
constexpr size_t kShareOfMoved = 8;

}  // namespace

void PairOrder::Update(std::span<const PairKey> keys, std::span<const int> before,
                       const PairKeyCounts& counts) {
  keys_.swap(last_keys_);
  keys_.assign(keys.begin(), keys.end());
  moved_.clear();
  kept_.assign(last_keys_.size(), -1);
  for (size_t i = 0; i < keys_.size(); ++i) {
    if (before[i] >= 0 && last_keys_[before[i]] == keys_[i]) {
      kept_[before[i]] = static_cast<int>(i);
    } else {
      moved_.push_back(static_cast<int>(i));
    }
  }
  if (moved_.size() > keys_.size() / kShareOfMoved) {
    SortAll(counts);
  } else {
    MoveSome();
  }
}

void PairOrder::MoveSome() {
  const auto earlier = [this](int i, int j) {
    return keys_[i] != keys_[j] ? keys_[i] < keys_[j] : i < j;
  };
  std::sort(moved_.begin(), moved_.end(), earlier);

  scratch_.clear();
  auto moved = moved_.begin();
  for (int last : order_) {
    const int pair = kept_[last];
    if (pair < 0) continue;
    while (moved != moved_.end() && keys_[*moved] < keys_[pair]) scratch_.push_back(*moved++);
    scratch_.push_back(pair);
  }
  scratch_.insert(scratch_.end(), moved, moved_.end());
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
