// SPDX-License-Identifier: MIT
#include "tests/bullet_adapter/recycling.h"

#include <LinearMath/btAlignedAllocator.h>

#include <cstddef>
#include <cstdlib>
#include <deque>
#include <map>

namespace cairn::test {
namespace {

constexpr std::size_t kHeader = 64;  // holds the size; also the largest alignment
constexpr std::size_t kHeldBack = 200;

Recycling mode = Recycling::kByTheSystem;

using Waiting = std::map<std::size_t, std::deque<char*>>;

/// Blocks that were given back, by size.
Waiting& Given() {
  static Waiting* const given = new Waiting;  // static objects of Bullet are freed after it
  return *given;
}

char* Reuse(std::size_t size) {
  if (mode == Recycling::kByTheSystem) return nullptr;
  std::deque<char*>& blocks = Given()[size];
  if (blocks.size() <= (mode == Recycling::kLate ? kHeldBack : 0)) return nullptr;
  char* const block = mode == Recycling::kLate ? blocks.front() : blocks.back();
  mode == Recycling::kLate ? blocks.pop_front() : blocks.pop_back();
  return block;
}

void* Allocate(std::size_t size, int) {
  const std::size_t rounded = (size + 2 * kHeader - 1) / kHeader * kHeader;
  char* block = Reuse(rounded);
  if (block == nullptr) block = static_cast<char*>(std::aligned_alloc(kHeader, rounded));
  if (block == nullptr) return nullptr;
  *reinterpret_cast<std::size_t*>(block) = rounded;
  return block + kHeader;
}

void Free(void* memory) {
  char* const block = static_cast<char*>(memory) - kHeader;
  if (mode == Recycling::kByTheSystem) {
    std::free(block);
  } else {
    Given()[*reinterpret_cast<std::size_t*>(block)].push_back(block);
  }
}

}  // namespace

void SetRecycling(Recycling recycling) {
  mode = recycling;
  for (auto& [size, blocks] : Given()) {
    for (char* block : blocks) std::free(block);
    blocks.clear();
  }
  btAlignedAllocSetCustomAligned(Allocate, Free);
}

}  // namespace cairn::test
