// SPDX-License-Identifier: MIT
// Memory whose addresses come again at once, late, or as the system likes: no bit may depend on it.
#pragma once

#include <cstddef>

namespace cairn::test {

/// What becomes of memory that was given back.
enum class Recycling {
  kByTheSystem,
  kAtOnce,  ///< The next of that size gets the same address.
  kLate,    ///< Only once some hundred others of that size were given back.
};

/// For all that follows, on all threads. What was allocated before may be freed after it.
void SetRecycling(Recycling recycling);

/// Aligned to 64 bytes; nullptr if there is none.
void* TakeMemory(std::size_t size);
void GiveMemory(void* memory);

/// In the whole process.
std::size_t BytesInUse();

}  // namespace cairn::test
