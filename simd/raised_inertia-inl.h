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
    const Vector<V> a = Read(d, axes.axis, l), b = Read(d, axes.axis + 3, l);
    const Vector<V> c = Read(d, axes.axis + 6, l);
    const Vector<V> found = Read(d, axes.moment, l);
    const Vector<V> inv_moments = {hn::Max(found.x, zero), hn::Max(found.y, zero),
                                   hn::Max(found.z, zero)};

    // at least what K turns by about each axis
    const auto entry = [&](int k) HWY_ATTR { return hn::Load(d, lanes->stiffness[k] + l); };
    const Vector<V> x = {entry(0), entry(1), entry(2)}, y = {x.y, entry(3), entry(4)};
    const Vector<V> z = {x.z, y.z, entry(5)};
    const auto turned = [&](const Vector<V>& axis) HWY_ATTR {
      // the last from right to left: bits are those of the first version
      const V of_z =
          hn::Add(hn::Mul(z.x, axis.x), hn::Add(hn::Mul(z.y, axis.y), hn::Mul(z.z, axis.z)));
      return Vector<V>{Dot(x, axis), Dot(y, axis), of_z};
    };
    const Vector<V> of_a = turned(a), of_b = turned(b), of_c = turned(c);
    const V ab = hn::Abs(Dot(a, of_b)), ac = hn::Abs(Dot(a, of_c)), bc = hn::Abs(Dot(b, of_c));
    const Vector<V> held = Read(d, lanes->held, l);
    const auto stiffness_of = [&](V own, V other, V third, V before) HWY_ATTR {
      const V most = hn::Max(hn::Add(hn::Add(own, other), third), zero);
      return hn::Max(most, hn::Mul(hold, before));
    };
    Vector<V> k = {stiffness_of(Dot(a, of_a), ab, ac, held.x),
                   stiffness_of(Dot(b, of_b), ab, bc, held.y),
                   stiffness_of(Dot(c, of_c), ac, bc, held.z)};

    // axes of equal moments turn with rounding: they share what any of them needs
    const auto same = [&](V less, V more) HWY_ATTR {
      return hn::Le(hn::Sub(more, less), hn::Mul(same_moment, more));
    };
    const auto share = [&](auto equal, V* first, V* second) HWY_ATTR {
      const V most = hn::Max(*first, *second);
      *first = hn::IfThenElse(equal, most, *first);
      *second = hn::IfThenElse(equal, most, *second);
    };
    const auto same_first = same(inv_moments.x, inv_moments.y);
    share(same_first, &k.x, &k.y);
    share(same(inv_moments.y, inv_moments.z), &k.y, &k.z);
    k.x = hn::IfThenElse(same_first, k.y, k.x);
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
