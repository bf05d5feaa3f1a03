// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

namespace cairn::cli {

/// Makes caches forget what a program worked on, as what a game does between two of its steps does.
class ColdCaches {
 public:
  static constexpr size_t kBytes = 24 << 20;

  ColdCaches() : memory_(kBytes / sizeof(size_t)) {}

  /// Writes kBytes.
  void Empty() {
    // other values each time, which depend on those before: nothing that a compiler may leave out
    size_t value = memory_.back();
    for (size_t& word : memory_) word = ++value;
  }

 private:
  std::vector<size_t> memory_;
};

}  // namespace cairn::cli
