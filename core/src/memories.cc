// SPDX-License-Identifier: MIT
#include "memories.h"

#include <algorithm>

namespace cairn {
namespace {

/// Frames an island may be absent before what was learnt about it is dropped.
constexpr int kForgetAfter = 120;
/// Keys of islands without names begin here.
constexpr std::uint64_t kUnnamed = std::uint64_t{1} << 63;

}  // namespace

IslandMemory* IslandMemories::Recall(const ContactProblem& problem, std::span<const int> bodies) {
  // without names from the caller, the position of the first body has to do
  std::uint64_t key = ~std::uint64_t{0};
  for (int body : bodies) {
    const std::uint64_t id = problem.bodies[body].id;
    key = std::min(key, id != 0 ? id : kUnnamed + static_cast<std::uint64_t>(body));
  }
  // two islands of one name must not share a system: the second goes by another name
  const int place = bodies.empty() ? 0 : bodies.front() + 1;
  while (memories_[key].last_frame == frame_) {
    key = key * 6364136223846793005u + static_cast<std::uint64_t>(place);
  }
  Remembered& remembered = memories_[key];
  remembered.last_frame = frame_;
  return &remembered.memory;
}

void IslandMemories::EndFrame() {
  ++frame_;
  std::erase_if(memories_, [this](const auto& entry) {
    return entry.second.last_frame < frame_ - kForgetAfter;
  });
}

}  // namespace cairn
