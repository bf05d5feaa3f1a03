// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "simd/pair_block.h"
#include "simd/target.h"

namespace cairn::simd {

/// How far something is to move along a direction, and 0 where that is to be forgotten, else 1.
struct Way {
  float beta = 0, keep = 0;
};

/// Numbers of a state that moves along a direction.
template <class Numbers>
struct Moving {
  Numbers* now;
  Numbers* last;
  Numbers* direction;
};

/// Passes over numbers of lanes that relax nothing. Same bits on every target.
struct LaneKernels {
  /// now += beta direction, direction := keep (now - last), last := now: so many lines.
  /// @param ways  ways[of_lane[l]] is that of lane l
  void (*move_lines)(const Way* ways, const std::int32_t* of_lane, int count,
                     const Moving<Line>& numbers);
  /// The same for so many bodies. @param ways  ways[of_body[i]] is that of body i
  void (*move_bodies)(const Way* ways, const std::int32_t* of_body, int count,
                      const Moving<BodyLane>& numbers);

  /// Raises @p largest to the errors of so many blocks, those of their unused lanes aside. What is
  /// not a number is passed over.
  void (*find_largest)(const PairBlock* blocks, const BlockError* errors, int count,
                       BlockError* largest);
  /// Adds their energies to @p sums, one for each lane, after rounding @p scale times them to whole
  /// numbers.
  void (*add_energies)(const PairBlock* blocks, const BlockError* errors, int count, double scale,
                       double* sums);
};

/// @pre the CPU supports it
const LaneKernels& LaneKernelsFor(Target target);

/// @p number >= 0 as a whole number, unless it is so large anyway. What is not a number stays so.
inline double Rounded(double number) {
  constexpr double kNoFractions = 4503599627370496.0;  // 2^52
  return (number + kNoFractions) - kNoFractions;
}

}  // namespace cairn::simd
