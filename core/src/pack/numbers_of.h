// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <type_traits>

#include "cairn/row.h"

namespace cairn {

// Structs of the caller's as the arrays that kernels read: one place for what C++ leaves to the
// layout, which is checked beside each use by offsetof.

/// All numbers of a struct that has floats alone.
template <class Struct>
auto NumbersOf(Struct& of) {
  static_assert(std::is_standard_layout_v<Struct> && sizeof(Struct) % sizeof(float) == 0);
  using Float = std::conditional_t<std::is_const_v<Struct>, const float, float>;
  return reinterpret_cast<Float*>(&of);
}

/// A row's side of one body: its linear part, then its angular part.
inline const double* SideOf(const Row& row, std::size_t linear_part) {
  static_assert(offsetof(Row, angular_a) == offsetof(Row, linear_a) + 3 * sizeof(double));
  static_assert(offsetof(Row, angular_b) == offsetof(Row, linear_b) + 3 * sizeof(double));
  return reinterpret_cast<const double*>(reinterpret_cast<const std::byte*>(&row) + linear_part);
}
inline const double* SideA(const Row& row) { return SideOf(row, offsetof(Row, linear_a)); }
inline const double* SideB(const Row& row) { return SideOf(row, offsetof(Row, linear_b)); }

}  // namespace cairn
