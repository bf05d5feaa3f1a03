// SPDX-License-Identifier: MIT
// Tiles of a dense front: two registers of rows and six columns, which with the pair of registers
// that is read and the number that multiplies it fill the sixteen registers of AVX2. Compiled once
// per target.
#if defined(CAIRN_SIMD_FRONT_TILE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAIRN_SIMD_FRONT_TILE_INL_H_
#undef CAIRN_SIMD_FRONT_TILE_INL_H_
#else
#define CAIRN_SIMD_FRONT_TILE_INL_H_
#endif

#include <algorithm>
#include <cstddef>

#include <hwy/highway.h>

#include "simd/fronts/front_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace cairn::simd {
namespace HWY_NAMESPACE {
namespace fronts {
namespace hn = hwy::HWY_NAMESPACE;

/// Columns of a tile: a body.
constexpr int kTile = 6;
/// A whole register, and one that has no more than the padding: the same but on AVX-512.
template <class T>
using Whole = hn::CappedTag<T, 64 / sizeof(T)>;
template <class T>
using Narrow = hn::CappedTag<T, kFrontPadding / sizeof(T)>;

template <class D>
constexpr int kWidth = static_cast<int>(hn::MaxLanes(D()));

template <class T>
constexpr int RoundDown(int row) {
  constexpr int kUnit = kFrontPadding / static_cast<int>(sizeof(T));
  return row / kUnit * kUnit;
}

/// A front with what follows from its shape.
template <class T>
struct View {
  explicit View(const Front<T>& front)
      : panel(front.panel),
        update(front.update),
        panel_stride(front.panel_stride()),
        update_stride(front.update_stride()),
        pivots(front.pivots),
        size(front.size),
        below(front.below()),
        rows(front.panel_stride()) {}

  T *panel, *update;
  std::ptrdiff_t panel_stride, update_stride;
  int pivots, size, below, rows;
};

/// Registers of one tile.
template <class D, int kRegisters, int kColumns>
struct Tile {
  hn::Vec<D> at[kRegisters][kColumns];

  HWY_INLINE void SetZero() {
    HWY_UNROLL(6)
    for (int r = 0; r < kRegisters; ++r) {
      HWY_UNROLL(6)
      for (int c = 0; c < kColumns; ++c) at[r][c] = hn::Zero(D());
    }
  }
  HWY_INLINE void Load(const hn::TFromD<D>* from, std::ptrdiff_t stride) {
    HWY_UNROLL(6)
    for (int r = 0; r < kRegisters; ++r) {
      HWY_UNROLL(6)
      for (int c = 0; c < kColumns; ++c) {
        at[r][c] = hn::LoadU(D(), from + c * stride + r * kWidth<D>);
      }
    }
  }
  HWY_INLINE void Store(hn::TFromD<D>* to, std::ptrdiff_t stride) const {
    HWY_UNROLL(6)
    for (int r = 0; r < kRegisters; ++r) {
      HWY_UNROLL(6)
      for (int c = 0; c < kColumns; ++c) {
        hn::StoreU(at[r][c], D(), to + c * stride + r * kWidth<D>);
      }
    }
  }

  /// Takes column k of `rows` times the numbers of `columns` in column k, for so many k.
  HWY_INLINE void Subtract(const hn::TFromD<D>* rows, const hn::TFromD<D>* columns,
                           std::ptrdiff_t stride, int depth) {
    for (int k = 0; k < depth; ++k) {
      hn::Vec<D> a[kRegisters];
      HWY_UNROLL(6)
      for (int r = 0; r < kRegisters; ++r) a[r] = hn::LoadU(D(), rows + r * kWidth<D>);
      HWY_UNROLL(6)
      for (int c = 0; c < kColumns; ++c) {
        const hn::Vec<D> b = hn::Set(D(), columns[c]);
        HWY_UNROLL(6)
        for (int r = 0; r < kRegisters; ++r) at[r][c] = hn::Sub(at[r][c], hn::Mul(a[r], b));
      }
      rows += stride;
      columns += stride;
    }
  }

  /// From the right with the transpose of a small factor.
  HWY_INLINE void SolveWith(const hn::TFromD<D>* factor, std::ptrdiff_t stride) {
    HWY_UNROLL(6)
    for (int c = 0; c < kColumns; ++c) {
      const hn::Vec<D> inverse = hn::Set(D(), factor[c * stride + c]);
      HWY_UNROLL(6)
      for (int r = 0; r < kRegisters; ++r) at[r][c] = hn::Mul(at[r][c], inverse);
      HWY_UNROLL(6)
      for (int later = c + 1; later < kColumns; ++later) {
        const hn::Vec<D> l = hn::Set(D(), factor[c * stride + later]);
        HWY_UNROLL(6)
        for (int r = 0; r < kRegisters; ++r) {
          at[r][later] = hn::Sub(at[r][later], hn::Mul(at[r][c], l));
        }
      }
    }
  }
};

/// Tile by tile over rows [first, last), both multiples of the padding.
template <class T, class Function>
HWY_INLINE void ForTiles(int first, int last, const Function& function) {
  constexpr int kWhole = kWidth<Whole<T>>, kNarrow = kWidth<Narrow<T>>;
  int row = first;
  for (; row + 2 * kWhole <= last; row += 2 * kWhole) {
    function.template operator()<Whole<T>, 2>(row);
  }
  if (row + kWhole <= last) {
    function.template operator()<Whole<T>, 1>(row);
    row += kWhole;
  }
  for (; row < last; row += kNarrow) function.template operator()<Narrow<T>, 1>(row);
}

/// Calls function with a constant 1 to kTile.
template <class Function>
HWY_INLINE auto WithColumns(int columns, const Function& function) {
  switch (columns) {
    case 1:
      return function.template operator()<1>();
    case 2:
      return function.template operator()<2>();
    case 3:
      return function.template operator()<3>();
    case 4:
      return function.template operator()<4>();
    case 5:
      return function.template operator()<5>();
    default:
      return function.template operator()<kTile>();
  }
}

}  // namespace fronts
}  // namespace HWY_NAMESPACE
}  // namespace cairn::simd
HWY_AFTER_NAMESPACE();

#endif
