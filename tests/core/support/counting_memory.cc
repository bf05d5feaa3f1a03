// SPDX-License-Identifier: MIT
#include "tests/core/support/counting_memory.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdlib>

namespace cairn::test {
namespace {

/// In front of a block.
struct Label {
  const CountingMemory* owner;
  std::size_t bytes, alignment;
};

std::size_t RoomOf(std::size_t alignment) {
  return std::max(alignment, std::bit_ceil(sizeof(Label)));
}

Label* LabelOf(void* block) { return static_cast<Label*>(block) - 1; }

}  // namespace

void* CountingMemory::Allocate(std::size_t bytes, std::size_t alignment) {
  if (bytes == 0 || !std::has_single_bit(alignment)) std::abort();
  if (calls_.fetch_add(1) == failing_) {
    if (throws_) throw 7;
    return nullptr;
  }
  const std::size_t room = RoomOf(alignment);
  const std::size_t line = std::max(alignment, alignof(std::max_align_t));
  void* const memory = std::aligned_alloc(line, (room + bytes + line - 1) / line * line);
  if (memory == nullptr) return nullptr;
  void* const block = static_cast<char*>(memory) + room;
  *LabelOf(block) = {this, bytes, alignment};
  ++blocks_;
  const std::size_t now = bytes_ += bytes;
  std::size_t most = most_;
  while (most < now && !most_.compare_exchange_weak(most, now)) continue;
  return block;
}

void CountingMemory::Free(void* block, std::size_t bytes, std::size_t alignment) noexcept {
  const Label label = *LabelOf(block);
  if (label.owner != this || label.bytes != bytes || label.alignment != alignment) std::abort();
  *LabelOf(block) = {};
  --blocks_;
  bytes_ -= bytes;
  std::free(static_cast<char*>(block) - RoomOf(alignment));
}

}  // namespace cairn::test
