// SPDX-License-Identifier: MIT
// Raised inertia, of as many bodies at a time as a register holds. Compiled once per target.
#if defined(CAIRN_SIMD_RAISED_INERTIA_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAIRN_SIMD_RAISED_INERTIA_INL_H_
#undef CAIRN_SIMD_RAISED_INERTIA_INL_H_
#else
#define CAIRN_SIMD_RAISED_INERTIA_INL_H_
#endif

#include <hwy/highway.h>

#include "simd/raised_inertia.h"

HWY_BEFORE_NAMESPACE();
namespace cairn::simd {
namespace HWY_NAMESPACE {
namespace raised_inertia {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct Vector {
  V x, y, z;
};

/// Products are summed from left to right, each rounded.
template <class V>
HWY_INLINE V Dot(const Vector<V>& a, const Vector<V>& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

/// Some lanes of numbers that lie side by side.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vector<V> Read(D d, const double (*from)[kLanes], int lane) {
  return {hn::Load(d, from[0] + lane), hn::Load(d, from[1] + lane), hn::Load(d, from[2] + lane)};
}
template <class D, class V = hn::Vec<D>>
HWY_INLINE void Write(D d, const Vector<V>& vector, double (*to)[kLanes], int lane) {
  hn::Store(vector.x, d, to[0] + lane);
  hn::Store(vector.y, d, to[1] + lane);
  hn::Store(vector.z, d, to[2] + lane);
}

/// A symmetric matrix: products of its axes, and what they are multiplied by.
template <class V>
class MatrixMaker {
 public:
  HWY_INLINE MatrixMaker(const Vector<V>& a, const Vector<V>& b, const Vector<V>& c)
      : xx_{hn::Mul(a.x, a.x), hn::Mul(b.x, b.x), hn::Mul(c.x, c.x)},
        yx_{hn::Mul(a.y, a.x), hn::Mul(b.y, b.x), hn::Mul(c.y, c.x)},
        zx_{hn::Mul(a.z, a.x), hn::Mul(b.z, b.x), hn::Mul(c.z, c.x)},
        yy_{hn::Mul(a.y, a.y), hn::Mul(b.y, b.y), hn::Mul(c.y, c.y)},
        zy_{hn::Mul(a.z, a.y), hn::Mul(b.z, b.y), hn::Mul(c.z, c.y)},
        zz_{hn::Mul(a.z, a.z), hn::Mul(b.z, b.z), hn::Mul(c.z, c.z)} {}

  template <class D>
  HWY_INLINE void Write(D d, const Vector<V>& eigenvalues, double (*to)[kLanes], int lane) const {
    hn::Store(Dot(xx_, eigenvalues), d, to[0] + lane);
    hn::Store(Dot(yx_, eigenvalues), d, to[1] + lane);
    hn::Store(Dot(zx_, eigenvalues), d, to[2] + lane);
    hn::Store(Dot(yy_, eigenvalues), d, to[3] + lane);
    hn::Store(Dot(zy_, eigenvalues), d, to[4] + lane);
    hn::Store(Dot(zz_, eigenvalues), d, to[5] + lane);
  }

 private:
  Vector<V> xx_, yx_, zx_, yy_, zy_, zz_;
};

/// A symmetric matrix.
template <class V>
class Symmetric {
 public:
  template <class D>
  HWY_INLINE Symmetric(D d, const double (*from)[kLanes], int lane) {
    const auto entry = [&](int k) HWY_ATTR { return hn::Load(d, from[k] + lane); };
    x_ = {entry(0), entry(1), entry(2)};
    y_ = {x_.y, entry(3), entry(4)};
    z_ = {x_.z, y_.z, entry(5)};
  }
  HWY_INLINE Vector<V> Times(const Vector<V>& axis) const {
    // the last from right to left: bits are those of the first version
    const V of_z =
        hn::Add(hn::Mul(z_.x, axis.x), hn::Add(hn::Mul(z_.y, axis.y), hn::Mul(z_.z, axis.z)));
    return {Dot(x_, axis), Dot(y_, axis), of_z};
  }

 private:
  Vector<V> x_, y_, z_;
};

/// An axis, and what a matrix makes of it.
template <class V>
struct Turned {
  Vector<V> axis, of;
};

/// Where the mask is set, turns two axes in their plane so that a matrix without negative
/// eigenvalues does not mix them, and the first one has less of it (a rotation of Jacobi's). What
/// is within rounding stays.
template <class M, class V>
HWY_INLINE void Unmix(M mask, Turned<V>* p, Turned<V>* q) {
  const hn::DFromV<V> d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1), two = hn::Set(d, 2);
  const V of_p = Dot(p->axis, p->of), of_q = Dot(q->axis, q->of), mixed = Dot(p->axis, q->of);
  const V twice = hn::Mul(two, mixed), apart = hn::Sub(of_q, of_p);
  const V rounding = hn::Mul(hn::Set(d, 1e-6), hn::Add(of_p, of_q));
  // tan = 2 m / (apart +- sqrt(apart^2 + (2 m)^2)), of the smaller angle
  const V root = hn::Sqrt(hn::Add(hn::Mul(apart, apart), hn::Mul(twice, twice)));
  const V divisor = hn::Add(apart, hn::IfThenElse(hn::Lt(apart, zero), hn::Neg(root), root));
  const auto turns = hn::And(mask, hn::Gt(hn::Abs(mixed), rounding));
  const V tan = hn::IfThenElse(turns, hn::Div(twice, hn::IfThenElse(turns, divisor, one)), zero);
  const V cos = hn::Div(one, hn::Sqrt(hn::Add(one, hn::Mul(tan, tan)))), sin = hn::Mul(tan, cos);
  // less of it first
  const V less = hn::Sub(of_p, hn::Mul(tan, mixed)), more = hn::Add(of_q, hn::Mul(tan, mixed));
  const auto swaps = hn::And(mask, hn::Gt(hn::Sub(less, more), rounding));
  const auto turn = [&](V* a, V* b) HWY_ATTR {
    const V x = hn::Sub(hn::Mul(cos, *a), hn::Mul(sin, *b));
    const V y = hn::Add(hn::Mul(sin, *a), hn::Mul(cos, *b));
    *a = hn::IfThenElse(swaps, y, x);
    *b = hn::IfThenElse(swaps, x, y);
  };
  const auto turn_all = [&](Vector<V>* a, Vector<V>* b) HWY_ATTR {
    turn(&a->x, &b->x);
    turn(&a->y, &b->y);
    turn(&a->z, &b->z);
  };
  turn_all(&p->axis, &q->axis);
  turn_all(&p->of, &q->of);
}

inline void RaiseInertia(const RaiseRules& rules, const PrincipalAxes& axes, RaisedInertia* lanes) {
  const hn::CappedTag<double, kLanes> d;
  using V = hn::Vec<decltype(d)>;
  const V one = hn::Set(d, 1), zero = hn::Zero(d);
  const V threshold = hn::Set(d, rules.threshold), hold = hn::Set(d, rules.hold);
  const V step2 = hn::Set(d, rules.time_step * rules.time_step);
  const V same_moment = hn::Set(d, rules.same_moment);
  const auto each = [&](const auto& function, const Vector<V>& a, const Vector<V>& b) HWY_ATTR {
    return Vector<V>{function(a.x, b.x), function(a.y, b.y), function(a.z, b.z)};
  };
  for (int l = 0; l < kLanes; l += static_cast<int>(hn::MaxLanes(d))) {
    Turned<V> first = {Read(d, axes.axis, l), {}}, second = {Read(d, axes.axis + 3, l), {}};
    Turned<V> third = {Read(d, axes.axis + 6, l), {}};
    const Vector<V> found = Read(d, axes.moment, l);
    const Vector<V> inv_moments = {hn::Max(found.x, zero), hn::Max(found.y, zero),
                                   hn::Max(found.z, zero)};

    // Any axes of equal moments are principal. Taken are the ones that lie along and across the
    // arms of joints: no force at an end of an arm turns a body about it.
    const auto same = [&](V less, V more) HWY_ATTR {
      return hn::Le(hn::Sub(more, less), hn::Mul(same_moment, more));
    };
    const auto same_first = same(inv_moments.x, inv_moments.y);
    const auto same_last = same(inv_moments.y, inv_moments.z);
    const auto same_all = hn::And(same_first, same_last);
    const Symmetric<V> arms(d, lanes->arms, l);
    for (Turned<V>* const one_of : {&first, &second, &third}) one_of->of = arms.Times(one_of->axis);
    if (!hn::AllFalse(d, hn::Or(same_first, same_last))) {
      // what is left of a mixture shrinks faster from round to round
      constexpr int kRounds = 4;
      Unmix(same_first, &first, &second);
      Unmix(same_last, &second, &third);
      Unmix(same_all, &first, &third);
      const int rounds = hn::AllFalse(d, same_all) ? 1 : kRounds;
      for (int round = 1; round < rounds; ++round) {
        Unmix(same_all, &first, &second);
        Unmix(same_all, &second, &third);
        Unmix(same_all, &first, &third);
      }
    }
    const Vector<V>&a = first.axis, &b = second.axis, &c = third.axis;
    const V arms_a = Dot(a, first.of), arms_b = Dot(b, second.of), arms_c = Dot(c, third.of);

    // at least what K turns by about each axis
    const Symmetric<V> stiffness(d, lanes->stiffness, l);
    const Vector<V> of_a = stiffness.Times(a), of_b = stiffness.Times(b), of_c = stiffness.Times(c);
    const V ab = hn::Abs(Dot(a, of_b)), ac = hn::Abs(Dot(a, of_c)), bc = hn::Abs(Dot(b, of_c));
    const Vector<V> held = Read(d, lanes->held, l);
    const auto stiffness_of = [&](V own, V mixed, V mixed_too, V before) HWY_ATTR {
      const V most = hn::Max(hn::Add(hn::Add(own, mixed), mixed_too), zero);
      return hn::Max(most, hn::Mul(hold, before));
    };
    Vector<V> k = {stiffness_of(Dot(a, of_a), ab, ac, held.x),
                   stiffness_of(Dot(b, of_b), ab, bc, held.y),
                   stiffness_of(Dot(c, of_c), ac, bc, held.z)};

    // all others of equal moments turn with rounding: they share what any of them needs
    const V on_line = hn::Set(d, rules.on_line);
    const auto apart = [&](V less, V more)
                           HWY_ATTR { return hn::Not(hn::Lt(less, hn::Mul(on_line, more))); };
    const auto share = [&](auto equal, V* one_of, V* other) HWY_ATTR {
      const V most = hn::Max(*one_of, *other);
      *one_of = hn::IfThenElse(equal, most, *one_of);
      *other = hn::IfThenElse(equal, most, *other);
    };
    const auto share_first = hn::And(same_first, apart(arms_a, arms_b));
    share(share_first, &k.x, &k.y);
    share(hn::And(same_last, hn::Or(same_first, apart(arms_b, arms_c))), &k.y, &k.z);
    k.x = hn::IfThenElse(share_first, k.y, k.x);
    Write(d, k, lanes->held, l);

    const auto times = [](V p, V q) HWY_ATTR { return hn::Mul(p, q); };
    const Vector<V> ratio = each(times, k, inv_moments);
    const auto largest = [](const Vector<V>& of)
                             HWY_ATTR { return hn::Max(hn::Max(of.x, of.y), of.z); };
    hn::Store(largest(ratio), d, lanes->held_ratio + l);
    const Vector<V> strain = {hn::Mul(step2, ratio.x), hn::Mul(step2, ratio.y),
                              hn::Mul(step2, ratio.z)};
    hn::Store(largest(strain), d, lanes->strain + l);
    const auto kept_of = [&](V of_axis) HWY_ATTR {
      return hn::Div(one, hn::Add(one, hn::Max(hn::Sub(of_axis, threshold), zero)));
    };
    const Vector<V> kept = {kept_of(strain.x), kept_of(strain.y), kept_of(strain.z)};
    const auto carried_of = [&](V now, V before)
                                HWY_ATTR { return hn::Min(hn::Div(now, before), one); };
    const Vector<V> carried = each(carried_of, kept, Read(d, lanes->kept, l));
    Write(d, kept, lanes->kept, l);

    const MatrixMaker<V> matrix(a, b, c);
    matrix.Write(d, kept, lanes->response, l);
    matrix.Write(d, carried, lanes->carried, l);
    matrix.Write(d, each(times, inv_moments, kept), lanes->inv_inertia, l);
  }
}

constexpr RaiseKernel kKernel = RaiseInertia;

}  // namespace raised_inertia
}  // namespace HWY_NAMESPACE
}  // namespace cairn::simd
HWY_AFTER_NAMESPACE();

#endif
