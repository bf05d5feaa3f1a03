// SPDX-License-Identifier: MIT
#include "tests/core/support/watched_new.h"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

#include "cairn/detail/memory.h"

namespace {

std::atomic<long> calls{0}, passing{0}, failing{-1};

void* Allocate(std::size_t size, std::size_t alignment) {
  if (calls.fetch_add(1) == failing.load()) throw std::bad_alloc();
  if (cairn::detail::MemoryOfThread() != nullptr) passing.fetch_add(1);
  const std::size_t rounded = (size + alignment - 1) / alignment * alignment;
  void* const memory = std::aligned_alloc(alignment, rounded == 0 ? alignment : rounded);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

[[gnu::noinline]] void* operator new(std::size_t size) {
  return Allocate(size, alignof(std::max_align_t));
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  return Allocate(size, static_cast<std::size_t>(alignment));
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace cairn::test {

long NewCalls() { return calls.load(); }
long NewCallsPastMemory() { return passing.load(); }

void FailNewAfter(long count) { failing = count < 0 ? -1 : calls.load() + count; }

}  // namespace cairn::test
