// SPDX-License-Identifier: MIT
#include "step/island_memories.h"

#include <algorithm>

#include "problem/body_name.h"

namespace cairn {
namespace {

/// Frames an island may be absent before what was learnt about it is dropped.
constexpr int kForgetAfter = 120;

}  // namespace

IslandMemory* IslandMemories::Recall(const ContactProblem& problem, std::span<const int> bodies) {
  std::uint64_t key = ~std::uint64_t{0};
  for (int body : bodies) key = std::min(key, BodyNameOf(problem.bodies[body], body));
  return Recall(key, bodies.empty() ? -1 : bodies.front());
}

IslandMemory* IslandMemories::Recall(std::uint64_t key, int first_body) {
  // two islands of one name must not share a system: the second goes by another name
  // the count keeps it from coming back to itself
  for (std::uint64_t tries = 1; memories_[key].last_frame == frame_; ++tries) {
    key = key * 6364136223846793005u + static_cast<std::uint64_t>(first_body) + tries;
  }
  Remembered& remembered = memories_[key];
  remembered.last_frame = frame_;
  return remembered.memory.get();
}

void IslandMemories::EndFrame() {
  ++frame_;
  std::erase_if(memories_, [this](const auto& entry) {
    return entry.second.last_frame < frame_ - kForgetAfter;
  });
}

}  // namespace cairn
