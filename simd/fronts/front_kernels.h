// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "simd/target.h"

namespace cairn::simd {

/// Bytes that a column of a front is padded to.
inline constexpr int kFrontPadding = 32;
/// Pivots from which on the same bits come out wherever a front is cut: whole bodies and registers.
inline constexpr int kFrontStep = 24;
/// Numbers after the last of a front, or of a vector that is solved for, that kernels may read and
/// write.
inline constexpr int kFrontMargin = 16;

/// So many rows and their padding.
template <class T>
constexpr int PaddedRows(int rows) {
  constexpr int kUnit = kFrontPadding / static_cast<int>(sizeof(T));
  return (rows + kUnit - 1) / kUnit * kUnit;
}

/// A dense symmetric matrix, lower triangle, column-major, of which the first columns are to be
/// eliminated. What lies above the diagonal has no meaning.
template <class T>
struct Front {
  /// First columns, then those of L with 1 / L_kk on the diagonal. Rows are those of the pivots,
  /// padded, and the others, padded; padding is zero.
  T* panel;
  T* update;  ///< The other columns, without the rows of the pivots; then what is left there.
  int pivots, size;  ///< Columns of panel and update.

  int below() const { return PaddedRows<T>(pivots); }  ///< first row of the panel after the pivots
  int panel_stride() const { return below() + update_stride(); }
  int update_stride() const { return PaddedRows<T>(size); }
};

/// Rows from, from + 1 ... of an update that are rows to, to + 1 ... of the front that it is added
/// to: all of them pivots there, or none, in which case `to` counts from the first that is none.
struct RowRun {
  int from, to, count;
  bool pivots;
};

/// Steps of a sparse Cholesky factorisation and of solves with its factor. What columns before it
/// take from a number of the front is taken in ascending order, in two roundings each, and a sum
/// across rows has eight parts by row: same bits on every target, and wherever a front is cut.
template <class T>
struct FrontKernels {
  /// Eliminates all pivots, and writes what they add to `update`. False if one of them is not above
  /// its entry of @p floors, which are >= 0, one a pivot, or not finite; the front is spoilt then.
  bool (*factor)(const Front<T>& front, const T* floors);

  /// The same in parts. Columns [begin, end) that are pivots, in the rows that are pivots of that
  /// range: wants all rows of the columns before. @p begin and, but for the last, @p end are
  /// multiples of kFrontStep.
  bool (*factor_square)(const Front<T>& front, int begin, int end, const T* floors);
  /// Those columns in rows [first, last) of the panel, multiples of the padding, below the pivots
  /// of the range: after factor_square().
  void (*factor_rows)(const Front<T>& front, int begin, int end, int first, int last);
  /// Rows [first, last) of `update`, @p first a multiple of the padding: when all columns are
  /// factored.
  void (*update_rows)(const Front<T>& front, int first, int last);

  /// Adds the update of another front, whose rows are those of @p runs, ascending: columns that are
  /// pivots, before they are factored, and the others, after update_rows().
  void (*add_to_panel)(const Front<T>& from, std::span<const RowRun> runs, const Front<T>& to);
  void (*add_to_update)(const Front<T>& from, std::span<const RowRun> runs, const Front<T>& to);

  /// Solves with the columns of L, then takes their part from the rows below. @p x: one number a
  /// row of the panel, finite in the padding, and kFrontMargin.
  void (*forward)(const Front<T>& front, T* x);
  /// Solves with the transpose of L for the pivots; the rows below are known.
  void (*backward)(const Front<T>& front, T* x);
};

/// @pre the CPU supports it
template <class T>
const FrontKernels<T>& FrontKernelsFor(Target target);
template <>
const FrontKernels<float>& FrontKernelsFor(Target target);
template <>
const FrontKernels<double>& FrontKernelsFor(Target target);

}  // namespace cairn::simd
