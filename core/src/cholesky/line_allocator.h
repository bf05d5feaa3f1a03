// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "cairn/detail/memory.h"

namespace cairn {

/// Numbers from the beginning of a cache line on, which nobody has written to yet.
template <class T>
struct LineAllocator : detail::Allocator<T> {
  static constexpr std::size_t kLine = 64;

  using detail::Allocator<T>::Allocator;
  LineAllocator select_on_container_copy_construction() const noexcept { return {}; }
  void construct(T*) {}
  template <class... Value>
  void construct(T* at, Value... value) {
    *at = T(value...);
  }
  T* allocate(std::size_t count) {
    return static_cast<T*>(detail::TakeMemory(this->memory(), count * sizeof(T), kLine));
  }
  void deallocate(T* what, std::size_t count) noexcept {
    detail::GiveMemory(this->memory(), what, count * sizeof(T), kLine);
  }
};

}  // namespace cairn
