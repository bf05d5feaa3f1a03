// SPDX-License-Identifier: MIT
#include "support/machine/cold_caches.h"

namespace cairn::cli {

void ColdCaches::Empty() {
  // other values each time, which depend on those before: nothing that a compiler may leave out
  size_t value = memory_.back();
  for (size_t& word : memory_) word = ++value;
}

}  // namespace cairn::cli
