// SPDX-License-Identifier: MIT
// Gyroscopic terms, as many bodies at a time as a register holds. Compiled once per target.
#if defined(CAIRN_SIMD_GYROSCOPIC_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAIRN_SIMD_GYROSCOPIC_INL_H_
#undef CAIRN_SIMD_GYROSCOPIC_INL_H_
#else
#define CAIRN_SIMD_GYROSCOPIC_INL_H_
#endif

#include <hwy/highway.h>

#include <limits>

#include "simd/gyroscopic.h"

HWY_BEFORE_NAMESPACE();
namespace cairn::simd {
namespace HWY_NAMESPACE {
namespace gyroscopic {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct Vector {
  V x, y, z;
};
template <class V>
struct Turn {
  V x, y, z, w;
};

// a b + c d, each product rounded; likewise below
template <class V>
HWY_INLINE V Sum(V a, V b, V c, V d) {
  return hn::Add(hn::Mul(a, b), hn::Mul(c, d));
}
template <class V>
HWY_INLINE V Difference(V a, V b, V c, V d) {
  return hn::Sub(hn::Mul(a, b), hn::Mul(c, d));
}
template <class V>
HWY_INLINE V Dot(const Vector<V>& a, const Vector<V>& b) {
  return hn::Add(Sum(a.x, b.x, a.y, b.y), hn::Mul(a.z, b.z));
}
template <class V>
HWY_INLINE Vector<V> Cross(const Vector<V>& a, const Vector<V>& b) {
  return {Difference(a.y, b.z, a.z, b.y), Difference(a.z, b.x, a.x, b.z),
          Difference(a.x, b.y, a.y, b.x)};
}
template <class V>
HWY_INLINE Vector<V> Scaled(V scale, const Vector<V>& a) {
  return {hn::Mul(scale, a.x), hn::Mul(scale, a.y), hn::Mul(scale, a.z)};
}
template <class V>
HWY_INLINE Vector<V> Less(const Vector<V>& a, const Vector<V>& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
template <class V>
HWY_INLINE Turn<V> Inverse(const Turn<V>& q) {
  return {hn::Neg(q.x), hn::Neg(q.y), hn::Neg(q.z), q.w};
}

/// q v q*
template <class V>
HWY_INLINE Vector<V> Turned(const Turn<V>& q, const Vector<V>& v) {
  const Turn<V> p = {hn::Sub(Sum(q.w, v.x, q.y, v.z), hn::Mul(q.z, v.y)),
                     hn::Sub(Sum(q.w, v.y, q.z, v.x), hn::Mul(q.x, v.z)),
                     hn::Sub(Sum(q.w, v.z, q.x, v.y), hn::Mul(q.y, v.x)),
                     hn::Sub(Difference(hn::Neg(q.x), v.x, q.y, v.y), hn::Mul(q.z, v.z))};
  const Turn<V> r = Inverse(q);
  const auto part = [&](V a, V b, V c, V d, V e, V f) HWY_ATTR {
    return hn::Sub(hn::Add(Sum(p.w, a, b, r.w), hn::Mul(c, d)), hn::Mul(e, f));
  };
  return {part(r.x, p.x, p.y, r.z, p.z, r.y), part(r.y, p.y, p.z, r.x, p.x, r.z),
          part(r.z, p.z, p.x, r.y, p.y, r.x)};
}

/// x with (a b c) x = d. What is almost singular is not inverted.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vector<V> SolveColumns(D d, const Vector<V>& a, const Vector<V>& b, const Vector<V>& c,
                                  const Vector<V>& right) {
  const V one = hn::Set(d, 1), least = hn::Set(d, std::numeric_limits<hn::TFromD<D>>::epsilon());
  const Vector<V> b_c = Cross(b, c);
  const V determinant = Dot(a, b_c);
  const auto regular = hn::Gt(hn::Abs(determinant), least);
  const V inverse = hn::Div(one, hn::IfThenElse(regular, determinant, one));
  const V factor = hn::IfThenElse(regular, inverse, determinant);
  return {hn::Mul(factor, Dot(right, b_c)), hn::Mul(factor, Dot(a, Cross(right, c))),
          hn::Mul(factor, Dot(a, Cross(b, right)))};
}

/// One step of Newton's method on step w x I w + I (w - before) = 0, in the frame of the body.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vector<V> Change(D d, V step, const Vector<V>& moment, const Turn<V>& turn,
                            const Vector<V>& before) {
  const Vector<V> w = Turned(Inverse(turn), before);
  const Vector<V> momentum = {hn::Mul(moment.x, w.x), hn::Mul(moment.y, w.y),
                              hn::Mul(moment.z, w.z)};
  const Vector<V> residual = Scaled(step, Cross(w, momentum));
  // an entry of the Jacobian beside its diagonal
  const auto entry = [&](V spin, V of, V other)
                         HWY_ATTR { return hn::Mul(hn::Sub(hn::Mul(spin, of), other), step); };
  const auto minus_entry = [&](V spin, V of, V other) HWY_ATTR {
    return hn::Mul(hn::Sub(other, hn::Mul(spin, of)), step);
  };
  const Vector<V> x = {moment.x, entry(w.z, moment.x, momentum.z),
                       minus_entry(w.y, moment.x, momentum.y)};
  const Vector<V> y = {minus_entry(w.z, moment.y, momentum.z), moment.y,
                       entry(w.x, moment.y, momentum.x)};
  const Vector<V> z = {entry(w.y, moment.z, momentum.y), minus_entry(w.x, moment.z, momentum.x),
                       moment.z};
  return Less(Turned(turn, Less(w, SolveColumns(d, x, y, z, residual))), before);
}

template <class Scalar>
void FindTerms(Scalar time_step, const Scalar (*inv_moment)[kLanes], const Scalar (*turn)[kLanes],
               const Scalar (*spin)[kLanes], Scalar (*change)[kLanes]) {
  const hn::CappedTag<Scalar, kLanes> d;
  using V = hn::Vec<decltype(d)>;
  const auto one = hn::Set(d, 1), zero = hn::Zero(d);
  for (int l = 0; l < kLanes; l += static_cast<int>(hn::MaxLanes(d))) {
    const auto at = [&](const Scalar* numbers) HWY_ATTR { return hn::Load(d, numbers + l); };
    const auto moment = [&](const Scalar* inverse) HWY_ATTR {
      const auto turns = hn::Ne(at(inverse), zero);
      return hn::IfThenElseZero(turns, hn::Div(one, hn::IfThenElse(turns, at(inverse), one)));
    };
    const Vector<V> added =
        Change(d, hn::Set(d, time_step),
               Vector<V>{moment(inv_moment[0]), moment(inv_moment[1]), moment(inv_moment[2])},
               Turn<V>{at(turn[0]), at(turn[1]), at(turn[2]), at(turn[3])},
               Vector<V>{at(spin[0]), at(spin[1]), at(spin[2])});
    hn::Store(added.x, d, change[0] + l);
    hn::Store(added.y, d, change[1] + l);
    hn::Store(added.z, d, change[2] + l);
  }
}

constexpr GyroscopicKernels kKernels = {FindTerms<float>, FindTerms<double>};

}  // namespace gyroscopic
}  // namespace HWY_NAMESPACE
}  // namespace cairn::simd
HWY_AFTER_NAMESPACE();

#endif
