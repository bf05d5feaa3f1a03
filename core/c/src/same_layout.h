// SPDX-License-Identifier: MIT
// Structs of C and of C++ that are the same bytes.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#define CAIRN_SAME_SIZE(c_type, type) \
  static_assert(sizeof(c_type) == sizeof(type) && alignof(c_type) == alignof(type))
#define CAIRN_SAME_FIELD(c_type, c_field, type, field)                \
  static_assert(offsetof(c_type, c_field) == offsetof(type, field) && \
                sizeof(c_type::c_field) == sizeof(type::field))

namespace cairn::c {

/// A value of one language in the other, which has the same layout.
template <class To, class From>
To Same(const From& from) {
  static_assert(sizeof(To) == sizeof(From));
  return std::bit_cast<To>(from);
}

/// A span over an array likewise.
template <class To, class From>
std::span<To> Over(From* from, std::int32_t count) {
  static_assert(sizeof(To) == sizeof(From));
  return {reinterpret_cast<To*>(from), static_cast<std::size_t>(count)};
}
template <class To, class From>
std::span<To> Over(std::span<From> from) {
  return Over<To>(from.data(), static_cast<std::int32_t>(from.size()));
}

}  // namespace cairn::c
