// SPDX-License-Identifier: MIT
// Dense steps of a sparse Cholesky factorisation. Compiled once per target. A tile takes what many
// columns before it take from it in one go, so the numbers of the front are loaded and stored
// rarely, and meet the columns in ascending order whatever the tile is.
#if defined(CAIRN_SIMD_FRONT_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAIRN_SIMD_FRONT_KERNELS_INL_H_
#undef CAIRN_SIMD_FRONT_KERNELS_INL_H_
#else
#define CAIRN_SIMD_FRONT_KERNELS_INL_H_
#endif

#include <cmath>
#include <limits>

#include "simd/fronts/front_solve-inl.h"
#include "simd/fronts/front_tile-inl.h"

HWY_BEFORE_NAMESPACE();
namespace cairn::simd {
namespace HWY_NAMESPACE {
namespace fronts {

/// Columns that are finished in all rows before the next ones; a multiple of kTile and of the
/// padding, so that they end at a whole register.
constexpr int kPanel = 48;
/// Columns that are taken from later ones in one go: six rows of them stay in the first level
/// cache.
constexpr int kDepth = 96;
/// Bytes of rows that so many columns are taken from together: a part of the second level cache.
constexpr int kChunkBytes = 128 << 10;

/// Columns of the panel from `column` on, in some rows, without what columns [from, to) take.
template <class T, int kColumns>
struct PanelTiles {
  const View<T>& front;
  int column, from, to;

  template <class D, int kRegisters>
  HWY_INLINE void operator()(int row) const {
    Tile<D, kRegisters, kColumns> tile;
    T* const at = front.panel + column * front.panel_stride + row;
    const T* const taken = front.panel + from * front.panel_stride;
    tile.Load(at, front.panel_stride);
    tile.Subtract(taken + row, taken + column, front.panel_stride, to - from);
    tile.Store(at, front.panel_stride);
  }
};

/// The same up to `column`, and then solved with their small factor.
template <class T, int kColumns>
struct FactorTiles {
  const View<T>& front;
  int column, from;
  const T* small;
  std::ptrdiff_t small_stride;

  template <class D, int kRegisters>
  HWY_INLINE void operator()(int row) const {
    Tile<D, kRegisters, kColumns> tile;
    T* const at = front.panel + column * front.panel_stride + row;
    const T* const taken = front.panel + from * front.panel_stride;
    tile.Load(at, front.panel_stride);
    tile.Subtract(taken + row, taken + column, front.panel_stride, column - from);
    tile.SolveWith(small, small_stride);
    tile.Store(at, front.panel_stride);
  }
};

/// The same of a square on the diagonal, left in @p square and not solved.
template <class T, int kColumns>
struct SquareTiles {
  const View<T>& front;
  int column, from;
  T* square;
  std::ptrdiff_t square_stride;
  int square_row;

  template <class D, int kRegisters>
  HWY_INLINE void operator()(int row) const {
    Tile<D, kRegisters, kColumns> tile;
    const T* const taken = front.panel + from * front.panel_stride;
    tile.Load(front.panel + column * front.panel_stride + row, front.panel_stride);
    tile.Subtract(taken + row, taken + column, front.panel_stride, column - from);
    tile.Store(square + row - square_row, square_stride);
  }
};

/// The update without what columns [from, to) take; it is zero before the first.
template <class T, int kColumns>
struct UpdateTiles {
  const View<T>& front;
  int column, from, to;

  template <class D, int kRegisters>
  HWY_INLINE void operator()(int row) const {
    Tile<D, kRegisters, kColumns> tile;
    T* const at = front.update + column * front.update_stride + row;
    const T* const taken = front.panel + from * front.panel_stride + front.below;
    if (from == 0) {
      tile.SetZero();
    } else {
      tile.Load(at, front.update_stride);
    }
    tile.Subtract(taken + row, taken + column, front.panel_stride, to - from);
    tile.Store(at, front.update_stride);
  }
};

/// Cholesky factor of a square, in place, with inverses on the diagonal. From one pivot to the next
/// there is a division, but no root: roots are drawn when all pivots are known.
template <class T, int kColumns>
HWY_INLINE bool FactorSmall(T* square, int stride, const T* floors) {
  // values, not memory
  T c[kColumns][kColumns], inverses[kColumns];
  HWY_UNROLL(6)
  for (int j = 0; j < kColumns; ++j) {
    HWY_UNROLL(6)
    for (int i = j; i < kColumns; ++i) c[j][i] = square[j * stride + i];
  }
  bool fits = true;
  HWY_UNROLL(6)
  for (int k = 0; k < kColumns; ++k) {
    // neither holds for what is not a number
    fits &= c[k][k] > floors[k];
    fits &= c[k][k] <= std::numeric_limits<T>::max();
    inverses[k] = T(1) / c[k][k];
    HWY_UNROLL(6)
    for (int j = k + 1; j < kColumns; ++j) {
      const T scaled = c[k][j] * inverses[k];
      HWY_UNROLL(6)
      for (int i = j; i < kColumns; ++i) c[j][i] -= c[k][i] * scaled;
    }
  }
  HWY_UNROLL(6)
  for (int k = 0; k < kColumns; ++k) {
    const T inverse_root = std::sqrt(inverses[k]);
    square[k * stride + k] = inverse_root;
    HWY_UNROLL(6)
    for (int i = k + 1; i < kColumns; ++i) square[k * stride + i] = c[k][i] * inverse_root;
  }
  return fits;
}

/// One tile wide, in rows up to @p last. Columns before `from` have taken theirs.
template <class T, int kColumns>
HWY_INLINE bool FactorColumns(const View<T>& front, int column, int from, int last,
                              const T* floors) {
  // up to a register of rows before and after those of the square
  constexpr int kSquareStride =
      PaddedRows<T>(kTile) + 2 * kFrontPadding / static_cast<int>(sizeof(T));
  alignas(64) T square[kTile * kSquareStride];
  const int first = RoundDown<T>(column);
  ForTiles<T>(first, PaddedRows<T>(column + kColumns),
              SquareTiles<T, kColumns>{front, column, from, square, kSquareStride, first});
  T* const small = square + (column - first);
  if (!FactorSmall<T, kColumns>(small, kSquareStride, floors)) return false;

  ForTiles<T>(RoundDown<T>(column + kColumns), last,
              FactorTiles<T, kColumns>{front, column, from, small, kSquareStride});
  // last: the tiles begin at a whole register, above the end of the square
  T* const at = front.panel + column * front.panel_stride + column;
  HWY_UNROLL(6)
  for (int k = 0; k < kColumns; ++k) {
    HWY_UNROLL(6)
    for (int i = k; i < kColumns; ++i) {
      at[k * front.panel_stride + i] = small[k * kSquareStride + i];
    }
  }
  return true;
}

/// Rows [first, last) of columns [begin, end), without what columns before them take.
template <class T>
void UpdatePanel(const View<T>& front, int begin, int end, int first, int last) {
  for (int from = 0; from < begin; from += kDepth) {
    const int to = std::min(from + kDepth, begin);
    for (int column = begin; column < end; column += kTile) {
      WithColumns(std::min(kTile, end - column), [&]<int kColumns>() {
        ForTiles<T>(std::max(first, RoundDown<T>(column)), last,
                    PanelTiles<T, kColumns>{front, column, from, to});
      });
    }
  }
}

/// @p last: where the rows of the square end in the panel.
template <class T>
bool FactorSquareRows(const View<T>& front, int begin, int end, int last, const T* floors) {
  UpdatePanel(front, begin, end, begin, last);
  for (int column = begin; column < end; column += kTile) {
    const bool fits = WithColumns(std::min(kTile, end - column), [&]<int kColumns>() {
      return FactorColumns<T, kColumns>(front, column, begin, last, floors + column);
    });
    if (!fits) return false;
  }
  return true;
}

template <class T>
bool FactorSquare(const Front<T>& front, int begin, int end, const T* floors) {
  return FactorSquareRows(View<T>(front), begin, end, PaddedRows<T>(end), floors);
}

template <class T>
void FactorRowsOf(const View<T>& front, int begin, int end, int first, int last) {
  UpdatePanel(front, begin, end, first, last);
  for (int column = begin; column < end; column += kTile) {
    WithColumns(std::min(kTile, end - column), [&]<int kColumns>() {
      const T* const small = front.panel + column * (front.panel_stride + 1);
      ForTiles<T>(first, last,
                  FactorTiles<T, kColumns>{front, column, begin, small, front.panel_stride});
    });
  }
}

template <class T>
void FactorRows(const Front<T>& front, int begin, int end, int first, int last) {
  FactorRowsOf(View<T>(front), begin, end, first, last);
}

template <class T>
void UpdateRowsOf(const View<T>& front, int first, int last) {
  const int columns = std::min(last, front.size), end = PaddedRows<T>(last);
  for (int from = 0; from < front.pivots; from += kDepth) {
    const int to = std::min(from + kDepth, front.pivots);
    for (int column = 0; column < columns; column += kTile) {
      WithColumns(std::min(kTile, front.size - column), [&]<int kColumns>() {
        ForTiles<T>(std::max(first, RoundDown<T>(column)), end,
                    UpdateTiles<T, kColumns>{front, column, from, to});
      });
    }
  }
}

template <class T>
void UpdateRows(const Front<T>& front, int first, int last) {
  UpdateRowsOf(View<T>(front), first, last);
}

template <class T>
bool Factor(const Front<T>& whole, const T* floors) {
  constexpr int kChunk = RoundDown<T>(kChunkBytes / static_cast<int>(sizeof(T)) / kDepth);
  const View<T> front(whole);
  const int rows = front.rows, pivots = front.pivots;
  if (pivots <= kPanel && rows <= 2 * kChunk) {
    if (!FactorSquareRows(front, 0, pivots, rows, floors)) return false;
  } else {
    for (int begin = 0; begin < pivots; begin += kPanel) {
      const int end = std::min(begin + kPanel, pivots);
      if (!FactorSquareRows(front, begin, end, PaddedRows<T>(end), floors)) return false;
      for (int first = PaddedRows<T>(end); first < rows; first += kChunk) {
        FactorRowsOf(front, begin, end, first, std::min(first + kChunk, rows));
      }
    }
  }
  for (int first = 0; first < front.size; first += kChunk) {
    UpdateRowsOf(front, first, std::min(first + kChunk, front.size));
  }
  return true;
}

/// Runs are a body or a few.
template <class T>
HWY_INLINE void AddRun(const T* HWY_RESTRICT from, T* HWY_RESTRICT to, int count) {
  using D = Narrow<T>;
  using Half = hn::CappedTag<T, kFrontPadding / sizeof(T) / 2>;
  int i = 0;
  for (; i + kWidth<D> <= count; i += kWidth<D>) {
    hn::StoreU(hn::Add(hn::LoadU(D(), to + i), hn::LoadU(D(), from + i)), D(), to + i);
  }
  for (; i + kWidth<Half> <= count; i += kWidth<Half>) {
    hn::StoreU(hn::Add(hn::LoadU(Half(), to + i), hn::LoadU(Half(), from + i)), Half(), to + i);
  }
  for (; i < count; ++i) to[i] += from[i];
}

template <class T>
void AddToPanel(const Front<T>& from, std::span<const RowRun> runs, const Front<T>& to) {
  const std::ptrdiff_t from_stride = from.update_stride(), to_stride = to.panel_stride();
  const int below = to.below();
  for (; !runs.empty() && runs[0].pivots; runs = runs.subspan(1)) {
    for (int j = 0; j < runs[0].count; ++j) {
      const T* const source = from.update + (runs[0].from + j) * from_stride;
      T* const target = to.panel + (runs[0].to + j) * to_stride;
      int skip = j;
      for (const RowRun& rows : runs) {
        const int row = rows.pivots ? rows.to : rows.to + below;
        AddRun(source + rows.from + skip, target + row + skip, rows.count - skip);
        skip = 0;
      }
    }
  }
}

template <class T>
void AddToUpdate(const Front<T>& from, std::span<const RowRun> runs, const Front<T>& to) {
  const std::ptrdiff_t from_stride = from.update_stride(), to_stride = to.update_stride();
  while (!runs.empty() && runs[0].pivots) runs = runs.subspan(1);
  for (; !runs.empty(); runs = runs.subspan(1)) {
    for (int j = 0; j < runs[0].count; ++j) {
      const T* const source = from.update + (runs[0].from + j) * from_stride;
      T* const target = to.update + (runs[0].to + j) * to_stride;
      int skip = j;
      for (const RowRun& rows : runs) {
        AddRun(source + rows.from + skip, target + rows.to + skip, rows.count - skip);
        skip = 0;
      }
    }
  }
}

template <class T>
constexpr FrontKernels<T> kKernels = {Factor<T>,     FactorSquare<T>, FactorRows<T>, UpdateRows<T>,
                                      AddToPanel<T>, AddToUpdate<T>,  Forward<T>,    Backward<T>};

}  // namespace fronts
}  // namespace HWY_NAMESPACE
}  // namespace cairn::simd
HWY_AFTER_NAMESPACE();

#endif
