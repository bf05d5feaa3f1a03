// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <cstddef>

namespace cairn {

/// Where a Solver, Contacts or Joints get their memory from, for a game that counts or places its
/// own. Asked only while something grows: docs/engine.md, Memory. By the threads of a Solver, at
/// the same time where there are several, and at last by a task of an Executor that is run when the
/// Solver is gone: it must outlive them.
class Memory {
 public:
  virtual ~Memory() = default;

  /// So many bytes, at least 1, at a multiple of @p alignment, a power of two. What it throws, and
  /// nullptr, become std::bad_alloc; a Solver is as new after that.
  virtual void* Allocate(std::size_t bytes, std::size_t alignment) = 0;
  /// Takes back what Allocate() gave for these two numbers.
  virtual void Free(void* memory, std::size_t bytes, std::size_t alignment) noexcept = 0;
};

}  // namespace cairn
