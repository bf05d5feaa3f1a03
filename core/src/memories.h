// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>

#include "cairn/contact_problem.h"
#include "subspace/policy.h"

namespace cairn {

/// What was learnt about each island, from frame to frame.
class IslandMemories {
 public:
  /// The memory of the island of these bodies (ascending). It stays where it is until EndFrame().
  IslandMemory* Recall(const ContactProblem& problem, std::span<const int> bodies);
  /// Drops islands that have not been seen for a while.
  void EndFrame();

 private:
  struct Remembered {
    IslandMemory memory;
    int last_frame = 0;
  };

  std::unordered_map<std::uint64_t, Remembered> memories_;
  int frame_ = 1;
};

}  // namespace cairn
