// SPDX-License-Identifier: MIT
// Room is made before anything changes: where memory ends, nothing has.
#pragma once

#include <algorithm>
#include <cstddef>

namespace cairn {

/// Makes room for so many more elements, at least twice as much as there was if there is none.
template <class Array>
void MakeRoom(std::size_t more, Array* array) {
  const std::size_t needed = array->size() + more;
  if (needed > array->capacity()) array->reserve(std::max(needed, 2 * array->capacity()));
}

}  // namespace cairn
