// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

namespace cairn::micro {

/// Numbers that take as long as any others: not infinite, no NaN, and no denormal one, which some
/// processors are slow with.
inline bool AllSound(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(),
                     [](float value) { return value == 0 || std::isnormal(value); });
}

}  // namespace cairn::micro
