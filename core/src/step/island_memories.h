// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <unordered_map>
#include <utility>

#include "cairn/contact_problem.h"
#include "cairn/detail/memory.h"
#include "step/island_memory.h"

namespace cairn {

/// What was learnt about each island, from frame to frame. A copy has copies of its own.
class IslandMemories {
 public:
  /// The memory of an island, by the smallest BodyNameOf() of its bodies and the place of the
  /// first. It stays where it is until EndFrame().
  IslandMemory* Recall(std::uint64_t key, int first_body);
  /// The same. @p bodies: ascending
  IslandMemory* Recall(const ContactProblem& problem, std::span<const int> bodies);
  /// Drops islands that have not been seen for a while.
  void EndFrame();

 private:
  /// Small, as all of them are looked at in every frame.
  struct Remembered {
    Remembered() = default;
    Remembered(const Remembered& other)
        : memory(std::make_unique<IslandMemory>(*other.memory)), last_frame(other.last_frame) {}
    Remembered& operator=(const Remembered&) = delete;

    std::unique_ptr<IslandMemory> memory = std::make_unique<IslandMemory>();
    std::int64_t last_frame = 0;
  };

  using Entry = std::pair<const std::uint64_t, Remembered>;
  std::unordered_map<std::uint64_t, Remembered, std::hash<std::uint64_t>,
                     std::equal_to<std::uint64_t>, detail::Allocator<Entry>>
      memories_;
  std::int64_t frame_ = 1;
};

}  // namespace cairn
