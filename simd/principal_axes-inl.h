// SPDX-License-Identifier: MIT
// Principal axes, of as many bodies at a time as a register holds. Compiled once per target.
#if defined(CAIRN_SIMD_PRINCIPAL_AXES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAIRN_SIMD_PRINCIPAL_AXES_INL_H_
#undef CAIRN_SIMD_PRINCIPAL_AXES_INL_H_
#else
#define CAIRN_SIMD_PRINCIPAL_AXES_INL_H_
#endif

#include <hwy/highway.h>

#include <limits>

#include "simd/principal_axes.h"

HWY_BEFORE_NAMESPACE();
namespace cairn::simd {
namespace HWY_NAMESPACE {
namespace principal_axes {
namespace hn = hwy::HWY_NAMESPACE;

/// The convergence is quadratic: three rounds are usual, and one more finds that nothing is left.
constexpr int kMostRounds = 8;

template <class V>
struct Column {
  V moment;
  V x, y, z;  ///< of its axis
};

/// a := c a - s b, b := s a + c b
template <class V>
HWY_INLINE void Turn(V c, V s, V* a, V* b) {
  const V before = *a;
  *a = hn::Sub(hn::Mul(c, before), hn::Mul(s, *b));
  *b = hn::Add(hn::Mul(s, before), hn::Mul(c, *b));
}

/// Turns two axes so that nothing is left between them, where that is more than rounding.
/// @param between          entry of the matrix beside its diagonal, of the two
/// @param a_other,b_other  of either and the third. Returns where it turned.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> Rotate(D d, Column<V>* a, Column<V>* b, V* between, V* a_other, V* b_other) {
  constexpr double kRounding = std::numeric_limits<double>::epsilon() / 2;
  const V one = hn::Set(d, 1), size = hn::Mul(a->moment, b->moment);
  const auto more = hn::Gt(hn::Mul(*between, *between),
                           hn::Mul(hn::Set(d, kRounding * kRounding), hn::Abs(size)));
  const V twice = hn::IfThenElse(more, hn::Add(*between, *between), one);
  const V theta = hn::Div(hn::Sub(b->moment, a->moment), twice);
  const V root = hn::Sqrt(hn::Add(hn::Mul(theta, theta), one));
  const V size_of_tangent = hn::Div(one, hn::Add(hn::Abs(theta), root));
  const V t = hn::IfThenElseZero(more, hn::CopySign(size_of_tangent, theta));
  const V c = hn::Div(one, hn::Sqrt(hn::Add(hn::Mul(t, t), one))), s = hn::Mul(t, c);
  const V moved = hn::Mul(t, *between);
  a->moment = hn::Sub(a->moment, moved);
  b->moment = hn::Add(b->moment, moved);
  *between = hn::IfThenZeroElse(more, *between);
  Turn(c, s, a_other, b_other);
  Turn(c, s, &a->x, &b->x);
  Turn(c, s, &a->y, &b->y);
  Turn(c, s, &a->z, &b->z);
  return more;
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE void Order(D, Column<V>* a, Column<V>* b) {
  const auto swap = hn::Lt(b->moment, a->moment);
  const auto order = [&](V* first, V* second) HWY_ATTR {
    const V before = *first;
    *first = hn::IfThenElse(swap, *second, before);
    *second = hn::IfThenElse(swap, before, *second);
  };
  order(&a->moment, &b->moment);
  order(&a->x, &b->x);
  order(&a->y, &b->y);
  order(&a->z, &b->z);
}

inline void FindPrincipalAxes(PrincipalAxes* lanes) {
  const hn::CappedTag<double, kLanes> d;
  using V = hn::Vec<decltype(d)>;
  const V one = hn::Set(d, 1), zero = hn::Zero(d);
  for (int l = 0; l < kLanes; l += static_cast<int>(hn::MaxLanes(d))) {
    const auto entry = [&](int k) HWY_ATTR { return hn::Load(d, lanes->matrix[k] + l); };
    Column<V> x = {entry(0), one, zero, zero}, y = {entry(3), zero, one, zero};
    Column<V> z = {entry(5), zero, zero, one};
    V yx = entry(1), zx = entry(2), zy = entry(4);
    for (int round = 0; round < kMostRounds; ++round) {
      const auto first = Rotate(d, &x, &y, &yx, &zx, &zy);
      const auto second = Rotate(d, &x, &z, &zx, &yx, &zy);
      const auto third = Rotate(d, &y, &z, &zy, &yx, &zx);
      if (hn::AllFalse(d, hn::Or(first, hn::Or(second, third)))) break;
    }
    Order(d, &x, &y);
    Order(d, &y, &z);
    Order(d, &x, &y);
    // how often a lane was looked at in vain shows in signs of zeros alone: none is negative then
    const auto put = [&](V numbers, double* to)
                         HWY_ATTR { hn::Store(hn::Add(numbers, zero), d, to + l); };
    const auto write = [&](int k, const Column<V>& column) HWY_ATTR {
      put(column.moment, lanes->moment[k]);
      put(column.x, lanes->axis[3 * k]);
      put(column.y, lanes->axis[3 * k + 1]);
      put(column.z, lanes->axis[3 * k + 2]);
    };
    write(0, x);
    write(1, y);
    write(2, z);
  }
}

constexpr PrincipalAxesKernel kKernel = FindPrincipalAxes;

}  // namespace principal_axes
}  // namespace HWY_NAMESPACE
}  // namespace cairn::simd
HWY_AFTER_NAMESPACE();

#endif
