// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "simd/target.h"

namespace cairn::micro {

/// A level of the memory of this machine.
struct MemoryLevel {
  std::string_view name;
  std::size_t stream_bytes;     ///< A working set that fits this level and none above.
  std::size_t capacity;         ///< What one core has of it.
  double bytes_per_second = 0;  ///< As read from one end to the other by one thread.
};

/// L1, L2, L3 and what is behind them.
class Memory {
 public:
  Memory();

  /// Reads a working set of each level until the figure is stable, in a second or so.
  void Measure(simd::Target target);

  const std::array<MemoryLevel, 4>& levels() const { return levels_; }
  const MemoryLevel& LevelOf(std::size_t working_set) const;

 private:
  std::array<MemoryLevel, 4> levels_;
};

}  // namespace cairn::micro
