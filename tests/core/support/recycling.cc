// SPDX-License-Identifier: MIT
#include "tests/core/support/recycling.h"

#include <malloc.h>

#include <cstdlib>
#include <mutex>

namespace cairn::test {
namespace {

constexpr std::size_t kHeader = 64;  // also the alignment
constexpr std::size_t kHeldBack = 200;
constexpr std::size_t kSizes = 4096;  // blocks of up to 256 KiB are recycled

struct Block {
  std::size_t size;  // with the header, a multiple of it
  Block* next;       // given back after this one
};

/// Blocks of one size that were given back: this is what operator new stands on, and has no other
/// memory than theirs.
struct Queue {
  Block *first = nullptr, *last = nullptr;
  std::size_t count = 0;
};

std::mutex mutex;
Recycling mode = Recycling::kByTheSystem;
Queue given[kSizes];

Block* TakeFirst(Queue* queue) {
  Block* const block = queue->first;
  queue->first = block->next;
  --queue->count;
  return block;
}

Block* Reuse(std::size_t size) {
  const std::lock_guard lock(mutex);
  if (mode == Recycling::kByTheSystem || size / kHeader >= kSizes) return nullptr;
  Queue& queue = given[size / kHeader];
  return queue.count > (mode == Recycling::kLate ? kHeldBack : 0) ? TakeFirst(&queue) : nullptr;
}

/// False if nobody waits for such a block.
bool Keep(Block* block) {
  const std::lock_guard lock(mutex);
  if (mode == Recycling::kByTheSystem || block->size / kHeader >= kSizes) return false;
  Queue& queue = given[block->size / kHeader];
  const bool in_front = mode == Recycling::kAtOnce || queue.count == 0;
  block->next = in_front && queue.count > 0 ? queue.first : nullptr;
  if (queue.count == 0) queue.last = block;
  if (in_front) {
    queue.first = block;
  } else {
    queue.last->next = block;
    queue.last = block;
  }
  ++queue.count;
  return true;
}

}  // namespace

void* TakeMemory(std::size_t size) {
  const std::size_t rounded = (size + 2 * kHeader - 1) / kHeader * kHeader;
  Block* block = Reuse(rounded);
  if (block == nullptr) block = static_cast<Block*>(std::aligned_alloc(kHeader, rounded));
  if (block == nullptr) return nullptr;
  block->size = rounded;
  return reinterpret_cast<char*>(block) + kHeader;
}

void GiveMemory(void* memory) {
  if (memory == nullptr) return;
  Block* const block = reinterpret_cast<Block*>(static_cast<char*>(memory) - kHeader);
  if (!Keep(block)) std::free(block);
}

void SetRecycling(Recycling recycling) {
  const std::lock_guard lock(mutex);
  mode = recycling;
  for (Queue& queue : given) {
    while (queue.count > 0) std::free(TakeFirst(&queue));
  }
}

std::size_t BytesInUse() {
  const auto info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

}  // namespace cairn::test
