// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>

#include "simd/pairs/pair_block.h"
#include "simd/rows/row_pack.h"
#include "simd/target.h"

namespace cairn::simd {

/// One number of every lane, as float or double.
template <class T>
using LineOf = std::conditional_t<std::is_same_v<T, double>, DoubleLine, Line>;

/// The two bodies of every lane: linear and angular part of a, then those of b.
inline constexpr int kPairLines = 12;
/// G' W G of every lane: the lower triangle of a with itself, column by column; rows of a and
/// columns of b, column by column; the lower triangle of b with itself.
inline constexpr int kTriangleLines = 21, kSquareLines = 36;
inline constexpr int kGramLines = 2 * kTriangleLines + kSquareLines;

/// Products with the G of one block, whose floats are @p lines (its pair lines first), computed in
/// T. Lanes that are not in use get anything. Same bits on every target.
template <class T>
struct PairProducts {
  using LineT = LineOf<T>;

  /// rows := G v, one line a row. @p v: kPairLines; the part of b is not read for kSingle.
  void (*multiply)(const PairBlock& block, const Line* lines, const LineT* v, LineT* rows);
  /// v := G' rows; the part of b is not written for kSingle.
  void (*multiply_transposed)(const PairBlock& block, const Line* lines, const LineT* rows,
                              LineT* v);
  /// gram := G' W G with @p weights one line a row. kGramLines; only the first triangle is written
  /// for kSingle.
  void (*weighted_gram)(const PairBlock& block, const Line* lines, const LineT* weights,
                        LineT* gram);
};

/// @pre the CPU supports it
template <class T>
const PairProducts<T>& PairProductsFor(Target target);
template <>
const PairProducts<float>& PairProductsFor(Target target);
template <>
const PairProducts<double>& PairProductsFor(Target target);

}  // namespace cairn::simd
