// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <cstddef>

#if !defined(__GNUC__) && defined(_M_X64)
#include <xmmintrin.h>
#endif

namespace cairn {

/// Asks for the cache line of an address, any address, before it is read.
inline void PrefetchLine([[maybe_unused]] const char* address) {
#if defined(__GNUC__)
  __builtin_prefetch(address);
#elif defined(_M_X64)
  _mm_prefetch(address, _MM_HINT_T0);
#endif
}

/// Asks for the cache lines of @p size bytes [1, ...) from @p begin on, before they are read. Any
/// address will do.
/// __builtin_prefetch() alone is not enough: GCC (12) takes a function that does nothing else for
/// one without effects, and leaves out its calls.
inline void Prefetch(const void* begin, std::size_t size = 1) {
  constexpr std::size_t kLine = 64;
  const char* const first = static_cast<const char*>(begin);
#if defined(__GNUC__)
  asm volatile("");
#endif
  for (std::size_t at = 0; at < size; at += kLine) PrefetchLine(first + at);
  // what does not begin a line may end in one more
  if (size > 1) PrefetchLine(first + size - 1);
}

}  // namespace cairn
