// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace cairn {

/// Where a row is predicted to end: strictly between its bounds, or at one of them. A friction row
/// at a bound slides, and the bound follows the impulse of its parent.
enum class RowSide : std::uint8_t { kFree, kLo, kHi };

}  // namespace cairn
