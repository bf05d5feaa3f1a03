// SPDX-License-Identifier: MIT
#pragma once

#include <LinearMath/btVector3.h>

#include <cstdint>

namespace cairn::bench {

/// Random numbers that are the same with every compiler and library, unlike the distributions of
/// <random>. SplitMix64: Steele, Lea, Flood, "Fast splittable pseudorandom number generators",
/// 2014.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t Bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  /// Within [low, high).
  double Within(double low, double high) {
    return low + (high - low) * (static_cast<double>(Bits() >> 11) * 0x1p-53);
  }

  /// Each coordinate within [-reach, reach).
  btVector3 InCube(double reach) {
    // One after the other: the order in which arguments are evaluated is the compiler's choice.
    const double x = Within(-reach, reach), y = Within(-reach, reach), z = Within(-reach, reach);
    return btVector3(static_cast<btScalar>(x), static_cast<btScalar>(y), static_cast<btScalar>(z));
  }

 private:
  std::uint64_t state_;
};

}  // namespace cairn::bench
