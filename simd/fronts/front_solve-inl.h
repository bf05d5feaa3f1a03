// SPDX-License-Identifier: MIT
// Solves with the factor of a dense front. Compiled once per target.
#if defined(CAIRN_SIMD_FRONT_SOLVE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAIRN_SIMD_FRONT_SOLVE_INL_H_
#undef CAIRN_SIMD_FRONT_SOLVE_INL_H_
#else
#define CAIRN_SIMD_FRONT_SOLVE_INL_H_
#endif

#include "simd/fronts/front_tile-inl.h"

HWY_BEFORE_NAMESPACE();
namespace cairn::simd {
namespace HWY_NAMESPACE {
namespace fronts {

template <class T, int kColumns>
HWY_INLINE void ForwardColumns(const View<T>& front, int column, T* x) {
  using D = Whole<T>;
  const std::ptrdiff_t stride = front.panel_stride;
  const T* const at = front.panel + column * stride;
  T known[kColumns];
  HWY_UNROLL(6)
  for (int k = 0; k < kColumns; ++k) known[k] = x[column + k];
  HWY_UNROLL(6)
  for (int k = 0; k < kColumns; ++k) {
    const T* const small = at + k * stride + column;
    known[k] *= small[k];
    HWY_UNROLL(6)
    for (int i = k + 1; i < kColumns; ++i) known[i] -= small[i] * known[k];
  }
  HWY_UNROLL(6)
  for (int k = 0; k < kColumns; ++k) x[column + k] = known[k];

  hn::Vec<D> solved[kColumns];
  HWY_UNROLL(6)
  for (int k = 0; k < kColumns; ++k) solved[k] = hn::Set(D(), known[k]);
  for (int row = column + kColumns; row < front.rows; row += kWidth<D>) {
    hn::Vec<D> y = hn::LoadU(D(), x + row);
    HWY_UNROLL(6)
    for (int k = 0; k < kColumns; ++k) {
      y = hn::Sub(y, hn::Mul(hn::LoadU(D(), at + k * stride + row), solved[k]));
    }
    hn::StoreU(y, D(), x + row);
  }
}

template <class T>
void Forward(const Front<T>& whole, T* x) {
  const View<T> front(whole);
  for (int column = 0; column < front.pivots; column += kTile) {
    WithColumns(std::min(kTile, front.pivots - column),
                [&]<int kColumns>() { ForwardColumns<T, kColumns>(front, column, x); });
  }
}

/// Parts of a sum across rows.
constexpr int kParts = 8;

/// Sums of L x over rows from @p first, one a column.
template <class T, int kColumns>
HWY_INLINE void SumRows(const View<T>& front, int column, const T* x, T* sums) {
  using D = hn::CappedTag<T, kParts>;
  constexpr int kRegisters = kParts / kWidth<D>;
  const std::ptrdiff_t stride = front.panel_stride;
  const T* const at = front.panel + column * stride;
  Tile<D, kRegisters, kColumns> parts;
  parts.SetZero();
  int row = column + kColumns;
  for (; row + kParts <= front.rows; row += kParts) {
    for (int r = 0; r < kRegisters; ++r) {
      const int from = row + r * kWidth<D>;
      const hn::Vec<D> y = hn::LoadU(D(), x + from);
      for (int c = 0; c < kColumns; ++c) {
        parts.at[r][c] =
            hn::Add(parts.at[r][c], hn::Mul(hn::LoadU(D(), at + c * stride + from), y));
      }
    }
  }
  alignas(64) T lanes[kTile * kParts];
  parts.Store(lanes, kParts);
  for (int c = 0; c < kColumns; ++c) {
    T* const s = lanes + c * kParts;
    for (int i = row; i < front.rows; ++i) s[i - row] += at[c * stride + i] * x[i];
    sums[c] = ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
  }
}

template <class T, int kColumns>
HWY_INLINE void BackwardColumns(const View<T>& front, int column, T* x) {
  T sums[kTile];
  SumRows<T, kColumns>(front, column, x, sums);
  const std::ptrdiff_t stride = front.panel_stride;
  const T* const small = front.panel + column * stride + column;
  T known[kColumns];
  HWY_UNROLL(6)
  for (int c = 0; c < kColumns; ++c) known[c] = x[column + c] - sums[c];
  HWY_UNROLL(6)
  for (int c = kColumns - 1; c >= 0; --c) {
    HWY_UNROLL(6)
    for (int i = c + 1; i < kColumns; ++i) known[c] -= small[c * stride + i] * known[i];
    known[c] *= small[c * stride + c];
  }
  HWY_UNROLL(6)
  for (int c = 0; c < kColumns; ++c) x[column + c] = known[c];
}

template <class T>
void Backward(const Front<T>& whole, T* x) {
  const View<T> front(whole);
  const int last = (front.pivots - 1) / kTile * kTile;
  for (int column = last; column >= 0; column -= kTile) {
    WithColumns(std::min(kTile, front.pivots - column),
                [&]<int kColumns>() { BackwardColumns<T, kColumns>(front, column, x); });
  }
}

}  // namespace fronts
}  // namespace HWY_NAMESPACE
}  // namespace cairn::simd
HWY_AFTER_NAMESPACE();

#endif
