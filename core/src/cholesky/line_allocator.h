// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <new>

namespace cairn {

/// Numbers from the beginning of a cache line on, which nobody has written to yet.
template <class T>
struct LineAllocator {
  using value_type = T;
  void construct(T*) {}
  template <class... Value>
  void construct(T* at, Value... value) {
    *at = T(value...);
  }
  T* allocate(std::size_t count) {
    return static_cast<T*>(::operator new(count * sizeof(T), std::align_val_t(64)));
  }
  void deallocate(T* memory, std::size_t) { ::operator delete(memory, std::align_val_t(64)); }
  bool operator==(const LineAllocator&) const { return true; }
};

}  // namespace cairn
