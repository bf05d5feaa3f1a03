// SPDX-License-Identifier: MIT
// A memory of one's own that counts, checks what it gets back, and ends when it is told to.
#pragma once

#include <atomic>
#include <cstddef>

#include "cairn/memory.h"

namespace cairn::test {

/// Stands on malloc: an operator new that counts does not see it. A block that comes back with
/// other numbers, or to another memory, ends the program.
class CountingMemory final : public Memory {
 public:
  void* Allocate(std::size_t bytes, std::size_t alignment) override;
  void Free(void* memory, std::size_t bytes, std::size_t alignment) noexcept override;

  /// That have not come back, and the most that it ever were.
  std::size_t bytes() const { return bytes_; }
  std::size_t most_bytes() const { return most_; }
  long blocks() const { return blocks_; }
  long calls() const { return calls_; }

  /// From now on lets so many allocations succeed, and the next one fail; a negative number lets
  /// all succeed.
  void FailAfter(long count) { failing_ = count < 0 ? -1 : calls_ + count; }
  /// Fails by an exception that is no std::bad_alloc, instead of nullptr.
  void FailByThrowing() { throws_ = true; }

 private:
  std::atomic<std::size_t> bytes_{0}, most_{0};
  std::atomic<long> blocks_{0}, calls_{0}, failing_{-1};
  bool throws_ = false;
};

}  // namespace cairn::test
