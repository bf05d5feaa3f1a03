// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
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
  /// The same of one that may be there already: it is at the new place alone from now on.
  void Put(const void* address);
  /// The place of an address, -1 if it is not there.
  int Find(const void* address);
  /// The next Find() is likely to be for the first one.
  void Rewind() { next_ = 0; }

 private:
  void FillTable();
  std::size_t HashOf(const void* address) const;
  /// Where its place is in the table, or would be.
  std::size_t SlotOf(const void* address) const;

  std::vector<const void*> addresses_;  ///< nullptr where one has another place now
  std::size_t next_ = 0;
  /// Open addressing: place + 1, or 0. Empty until it is needed.
  std::vector<int> table_;
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
