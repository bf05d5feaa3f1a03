// SPDX-License-Identifier: MIT
#include "address_index.h"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

void AddressIndex::Clear() {
  addresses_.clear();
  table_.clear();
  next_ = 0;
}

int AddressIndex::Find(const void* address) {
  // what has ended since is passed over
  constexpr std::size_t kAhead = 8;
  const std::size_t end = std::min(addresses_.size(), next_ + kAhead);
  for (std::size_t place = next_; place < end; ++place) {
    if (addresses_[place] != address) continue;
    next_ = place + 1;
    return static_cast<int>(place);
  }
  if (table_.empty()) FillTable();
  const int place = table_[SlotOf(address)] - 1;
  if (place >= 0) next_ = static_cast<std::size_t>(place) + 1;
  return place;
}

void AddressIndex::Put(const void* address) {
  if (2 * addresses_.size() + 2 > table_.size()) FillTable();
  int& place = table_[SlotOf(address)];
  if (place != 0) addresses_[place - 1] = nullptr;
  addresses_.push_back(address);
  place = static_cast<int>(addresses_.size());
}

void AddressIndex::FillTable() {
  table_.assign(std::bit_ceil(4 * addresses_.size() + 4), 0);
  for (std::size_t place = 0; place < addresses_.size(); ++place) {
    if (addresses_[place] == nullptr) continue;
    table_[SlotOf(addresses_[place])] = static_cast<int>(place) + 1;
  }
}

std::size_t AddressIndex::SlotOf(const void* address) const {
  std::size_t at = HashOf(address);
  while (table_[at] != 0 && addresses_[table_[at] - 1] != address) {
    at = (at + 1) & (table_.size() - 1);
  }
  return at;
}

std::size_t AddressIndex::HashOf(const void* address) const {
  const std::uint64_t mixed = reinterpret_cast<std::uintptr_t>(address) * 0x9e3779b97f4a7c15u;
  return (mixed >> 32) & (table_.size() - 1);
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
