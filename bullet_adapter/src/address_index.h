// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "cairn/bullet/precision.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// Finds things by address that are mostly asked for in the order in which they were added.
class AddressIndex {
 public:
  void Clear();
  /// The place of the address is the number of those before it.
  void Add(const void* address) { addresses_.push_back(address); }
  /// The place of an address, -1 if it is not there.
  int Find(const void* address);
  /// The next Find() is likely to be for the first one.
  void Rewind() { next_ = 0; }

 private:
  std::vector<const void*> addresses_;
  std::size_t next_ = 0;
  std::vector<std::pair<std::uintptr_t, int>> sorted_;  ///< empty until it is needed
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
