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
  for (std::size_t at = HashOf(address);; at = (at + 1) & (table_.size() - 1)) {
    if (table_[at] == 0) return -1;
    const int place = table_[at] - 1;
    if (addresses_[place] != address) continue;
    next_ = static_cast<std::size_t>(place) + 1;
    return place;
  }
}

void AddressIndex::FillTable() {
  table_.assign(std::bit_ceil(2 * addresses_.size() + 1), 0);
  for (std::size_t place = 0; place < addresses_.size(); ++place) {
    std::size_t at = HashOf(addresses_[place]);
    while (table_[at] != 0) at = (at + 1) & (table_.size() - 1);
    table_[at] = static_cast<int>(place) + 1;
  }
}

std::size_t AddressIndex::HashOf(const void* address) const {
  const std::uint64_t mixed = reinterpret_cast<std::uintptr_t>(address) * 0x9e3779b97f4a7c15u;
  return (mixed >> 32) & (table_.size() - 1);
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
