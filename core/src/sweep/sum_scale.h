// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace cairn {

/// Brings the largest number of a sum to so many bits: whole numbers add up to the same in any
/// order.
inline double SumScale(double largest, int bits) {
  const bool scalable = largest > 0 && std::isfinite(largest);
  return scalable ? std::ldexp(1.0, bits - 1 - std::ilogb(largest)) : 1;
}

}  // namespace cairn
