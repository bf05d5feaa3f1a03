// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "simd/pairs/pair_block.h"
#include "simd/target.h"

namespace cairn::simd {

/// How far something is to move along a direction, and 0 where that is to be forgotten, else 1.
struct Momentum {
  float beta = 0, keep = 0;
};

/// Numbers of a state that moves along a direction.
template <class Numbers>
struct Moving {
  Numbers* now;
  Numbers* last;
  Numbers* direction;
};

/// What some row of a block is.
struct RowsOfBlock {
  bool soft = false;     ///< without one all squares are 0
  bool bounded = false;  ///< has bounds of its own
};

/// Passes over numbers of lanes that relax nothing. Same bits on every target.
struct LaneKernels {
  /// now += beta direction, direction := keep (now - last), last := now: impulses of so many
  /// blocks. Lanes that are not used may move or not.
  /// @param momenta  momenta[of_lane[l]] is that of lane l; kLanes for each block
  /// @param numbers  where PairBlock::x counts from
  void (*move_blocks)(const Momentum* momenta, const PairBlock* blocks, const std::int32_t* of_lane,
                      int count, const Moving<Line>& numbers);
  /// The same for so many bodies. @param momenta  momenta[of_body[i]] is that of body i
  void (*move_bodies)(const Momentum* momenta, const std::int32_t* of_body, int count,
                      const Moving<BodyLane>& numbers);
  /// The sum of (now - last) . direction over bodies @p slots[0 .. count - 1]: of each of their
  /// eight numbers in their order, then of the eight.
  double (*find_progress)(const std::int32_t* slots, int count, const Moving<BodyLane>& numbers);

  /// Raises @p largest to the errors of so many blocks, those of their unused lanes aside. What is
  /// not a number is passed over.
  void (*find_largest)(const PairBlock* blocks, const BlockError* errors, int count,
                       BlockError* largest);
  /// Adds their energies to @p sums, one for each lane, after rounding @p scale times them to whole
  /// numbers.
  void (*add_energies)(const PairBlock* blocks, const BlockError* errors, int count, double scale,
                       double* sums);

  /// target'x and x'E x [J] of the rows of one block, to be written: kLanes numbers each, 0 in
  /// lanes that are not used. @p lines: the floats of the block; @p x: its impulses.
  RowsOfBlock (*find_gains)(const PairBlock& block, const Line* lines, const Line* x, double* gain,
                            double* square);
  /// |u|^2 of so many bodies.
  void (*find_squares)(const BodyLane* bodies, int count, double* squares);
  /// The largest |number|; what is not a number is passed over.
  double (*find_most)(const double* numbers, int count);
  /// The sum of @p scale times each number, rounded to whole numbers first.
  double (*add_rounded)(const double* numbers, int count, double scale);
};

/// @pre the CPU supports it
const LaneKernels& LaneKernelsFor(Target target);

/// @p number as a whole number, the nearest even one of two, unless it is so large anyway. What is
/// not a number stays so.
inline double Rounded(double number) {
  constexpr double kNoFractions = 6755399441055744.0;  // 1.5 * 2^52
  return (number + kNoFractions) - kNoFractions;
}

}  // namespace cairn::simd
