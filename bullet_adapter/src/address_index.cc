// SPDX-License-Identifier: MIT
#include "address_index.h"

#include <algorithm>

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

void AddressIndex::Clear() {
  addresses_.clear();
  sorted_.clear();
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
  if (sorted_.empty()) {
    for (const void* known : addresses_) {
      sorted_.emplace_back(reinterpret_cast<std::uintptr_t>(known),
                           static_cast<int>(sorted_.size()));
    }
    std::ranges::sort(sorted_);
  }
  const auto wanted = reinterpret_cast<std::uintptr_t>(address);
  const auto found = std::ranges::lower_bound(sorted_, std::pair(wanted, 0));
  if (found == sorted_.end() || found->first != wanted) return -1;
  next_ = found->second + 1;
  return found->second;
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
