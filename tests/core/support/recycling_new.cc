// SPDX-License-Identifier: MIT
// A program that links this has an operator new that recycles as SetRecycling() says.
#include <cstddef>
#include <new>

#include "tests/core/support/recycling.h"

namespace {

void* Allocate(std::size_t size) {
  void* const memory = cairn::test::TakeMemory(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

[[gnu::noinline]] void* operator new(std::size_t size) { return Allocate(size); }
/// @pre the alignment is 64 at most
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t) { return Allocate(size); }
[[gnu::noinline]] void operator delete(void* memory) noexcept { cairn::test::GiveMemory(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  cairn::test::GiveMemory(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  cairn::test::GiveMemory(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  cairn::test::GiveMemory(memory);
}
