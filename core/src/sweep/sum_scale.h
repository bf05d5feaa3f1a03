// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace cairn {

/// Brings the largest number of a sum to so many bits: whole numbers add up to the same in any
/// order.
inline double SumScale(double largest, int bits) {
  constexpr int kMantissaBits = 52, kBias = 1023;
  constexpr std::uint64_t kExponentOfNoNumber = 2 * kBias + 1;
  if (!(largest > 0)) return 1;
  const std::uint64_t exponent = std::bit_cast<std::uint64_t>(largest) >> kMantissaBits;
  if (exponent == kExponentOfNoNumber) return 1;
  // 2^(bits - 1 - ilogb(largest)); small sums are done before the functions of the library are
  const std::int64_t scale = bits - 1 + 2 * kBias - static_cast<std::int64_t>(exponent);
  const bool normal = exponent > 0 && scale > 0 && scale < 2 * kBias + 1;
  if (!normal) return std::ldexp(1.0, bits - 1 - std::ilogb(largest));
  return std::bit_cast<double>(static_cast<std::uint64_t>(scale) << kMantissaBits);
}

}  // namespace cairn
