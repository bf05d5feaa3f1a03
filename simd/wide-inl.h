// SPDX-License-Identifier: MIT
// Sixteen floats as one to four registers, and bodies gathered into them. Compiled once per target.
#if defined(CAIRN_SIMD_WIDE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAIRN_SIMD_WIDE_INL_H_
#undef CAIRN_SIMD_WIDE_INL_H_
#else
#define CAIRN_SIMD_WIDE_INL_H_
#endif

#include <cstdint>

#include <hwy/highway.h>

#include "simd/pairs/pair_block.h"

// Code without vectors is simd/pairs/pair_reference.cc.
#if HWY_TARGET != HWY_SCALAR
HWY_BEFORE_NAMESPACE();
namespace cairn::simd {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kLanes>;
using V = hn::Vec<D>;
constexpr int kWidth = static_cast<int>(hn::MaxLanes(D()));

/// Registers as a tree, so that the compiler sees values and never an array: each operation is done
/// on all registers before the next, which gives the core independent chains to work on.
template <int kRegisters>
struct Registers {
  Registers<kRegisters / 2> lo, hi;
};
template <>
struct Registers<1> {
  V v;
};
using Wide = Registers<kLanes / kWidth>;

#define CAIRN_BINARY(NAME)                                                                      \
  HWY_INLINE Registers<1> NAME(Registers<1> a, Registers<1> b) { return {hn::NAME(a.v, b.v)}; } \
  template <int n>                                                                              \
  HWY_INLINE Registers<n> NAME(const Registers<n>& a, const Registers<n>& b) {                  \
    return {NAME(a.lo, b.lo), NAME(a.hi, b.hi)};                                                \
  }
CAIRN_BINARY(Add)
CAIRN_BINARY(Sub)
CAIRN_BINARY(Mul)
CAIRN_BINARY(Div)
CAIRN_BINARY(Min)
CAIRN_BINARY(Max)
#undef CAIRN_BINARY

template <class T>
HWY_INLINE T LoadAs(const float* from) {
  if constexpr (sizeof(T) == sizeof(Registers<1>)) {
    return {hn::Load(D(), from)};
  } else {
    using Half = decltype(T::lo);
    constexpr int kHalf = static_cast<int>(sizeof(Half) / sizeof(float));
    return {LoadAs<Half>(from), LoadAs<Half>(from + kHalf)};
  }
}
HWY_INLINE Wide LoadLine(const Line& line) { return LoadAs<Wide>(line.lane); }

HWY_INLINE void StoreTo(float* to, Registers<1> a) { hn::Store(a.v, D(), to); }
template <int n>
HWY_INLINE void StoreTo(float* to, const Registers<n>& a) {
  StoreTo(to, a.lo);
  StoreTo(to + n / 2 * kWidth, a.hi);
}
HWY_INLINE void StoreLine(const Wide& a, Line* line) { StoreTo(line->lane, a); }

template <class T>
HWY_INLINE T SetAs(float value) {
  if constexpr (sizeof(T) == sizeof(Registers<1>)) {
    return {hn::Set(D(), value)};
  } else {
    using Half = decltype(T::lo);
    return {SetAs<Half>(value), SetAs<Half>(value)};
  }
}
HWY_INLINE Wide SetAll(float value) { return SetAs<Wide>(value); }

HWY_INLINE Registers<1> Abs(Registers<1> a) { return {hn::Abs(a.v)}; }
HWY_INLINE Registers<1> Neg(Registers<1> a) { return {hn::Neg(a.v)}; }
/// a where b > 0, else 0.
HWY_INLINE Registers<1> WherePositive(Registers<1> a, Registers<1> b) {
  return {hn::IfThenElseZero(hn::Gt(b.v, hn::Zero(D())), a.v)};
}
template <int n>
HWY_INLINE Registers<n> Abs(const Registers<n>& a) {
  return {Abs(a.lo), Abs(a.hi)};
}
template <int n>
HWY_INLINE Registers<n> Neg(const Registers<n>& a) {
  return {Neg(a.lo), Neg(a.hi)};
}
template <int n>
HWY_INLINE Registers<n> WherePositive(const Registers<n>& a, const Registers<n>& b) {
  return {WherePositive(a.lo, b.lo), WherePositive(a.hi, b.hi)};
}

/// a + b c, in two roundings on every target.
template <class T>
HWY_INLINE T AddProduct(const T& a, const T& b, const T& c) {
  return Add(a, Mul(b, c));
}

template <class T>
struct Three {
  T x, y, z;
};

/// Quarter @p part (0 linear, 1 angular) of every 4th body from the first on, one body for each
/// 128-bit block of a register.
template <class DQ>
HWY_INLINE hn::Vec<DQ> LoadQuarters(DQ d, const BodyLane* bodies, const std::int32_t* slot,
                                    int part) {
  if constexpr (hn::MaxLanes(DQ()) == 4) {
    return hn::Load(d, bodies[*slot].u + 4 * part);
  } else {
    const hn::Half<DQ> half;
    constexpr int kHalf = static_cast<int>(hn::MaxLanes(DQ())) / 2;
    return hn::Combine(d, LoadQuarters(half, bodies, slot + kHalf, part),
                       LoadQuarters(half, bodies, slot, part));
  }
}

template <class DQ>
HWY_INLINE void StoreQuarters(DQ d, hn::Vec<DQ> v, BodyLane* bodies, const std::int32_t* slot,
                              int part, int lanes) {
  if constexpr (hn::MaxLanes(DQ()) == 4) {
    if (lanes > 0) hn::Store(v, d, bodies[*slot].u + 4 * part);
  } else {
    const hn::Half<DQ> half;
    constexpr int kHalf = static_cast<int>(hn::MaxLanes(DQ())) / 2;
    StoreQuarters(half, hn::LowerHalf(half, v), bodies, slot, part, lanes);
    StoreQuarters(half, hn::UpperHalf(half, v), bodies, slot + kHalf, part, lanes - kHalf);
  }
}

/// Quarter @p part of one body in the first block of 128 bits, and zeros.
template <class DQ>
HWY_INLINE hn::Vec<DQ> LoadQuarter(DQ d, const BodyLane* bodies, std::int32_t slot, int part) {
  if constexpr (hn::MaxLanes(DQ()) == 4) {
    return hn::Load(d, bodies[slot].u + 4 * part);
  } else {
    return hn::ZeroExtendVector(d, LoadQuarter(hn::Half<DQ>(), bodies, slot, part));
  }
}

/// Whole-body loads and a transpose: element gathers are slower than scalar code on many CPUs.
/// Beyond the first @p lanes lanes, and those that are read with them, numbers are 0 or those of
/// the body of their slot. Few lanes, as blocks of small worlds have, take a third of the time.
template <class T>
HWY_INLINE Three<T> GatherAs(const BodyLane* bodies, const std::int32_t* slot, int part,
                             int lanes) {
  if constexpr (sizeof(T) == sizeof(Registers<1>)) {
    const D d;
    V r0, r1, r2, r3;
    if (lanes <= 4) {
      r0 = LoadQuarter(d, bodies, slot[0], part);
      r1 = LoadQuarter(d, bodies, slot[1], part);
      r2 = LoadQuarter(d, bodies, slot[2], part);
      r3 = LoadQuarter(d, bodies, slot[3], part);
    } else {
      r0 = LoadQuarters(d, bodies, slot, part);
      r1 = LoadQuarters(d, bodies, slot + 1, part);
      r2 = LoadQuarters(d, bodies, slot + 2, part);
      r3 = LoadQuarters(d, bodies, slot + 3, part);
    }
    const V xy02 = hn::InterleaveLower(d, r0, r2), xy13 = hn::InterleaveLower(d, r1, r3);
    const V zw02 = hn::InterleaveUpper(d, r0, r2), zw13 = hn::InterleaveUpper(d, r1, r3);
    return {{hn::InterleaveLower(d, xy02, xy13)},
            {hn::InterleaveUpper(d, xy02, xy13)},
            {hn::InterleaveLower(d, zw02, zw13)}};
  } else {
    using Half = decltype(T::lo);
    constexpr int kHalf = static_cast<int>(sizeof(Half) / sizeof(float));
    const auto lo = GatherAs<Half>(bodies, slot, part, lanes);
    const auto hi = GatherAs<Half>(bodies, slot + kHalf, part, lanes - kHalf);
    return {{lo.x, hi.x}, {lo.y, hi.y}, {lo.z, hi.z}};
  }
}

/// Writes what GatherAs() read, for the first @p lanes lanes.
HWY_INLINE void ScatterAs(const Three<Registers<1>>& u, BodyLane* bodies, const std::int32_t* slot,
                          int part, int lanes) {
  const D d;
  const V zero = hn::Zero(d);
  const V xz01 = hn::InterleaveLower(d, u.x.v, u.z.v), y01 = hn::InterleaveLower(d, u.y.v, zero);
  const V xz23 = hn::InterleaveUpper(d, u.x.v, u.z.v), y23 = hn::InterleaveUpper(d, u.y.v, zero);
  // within a block of four: the step between lanes of one register is 1
  StoreQuarters(d, hn::InterleaveLower(d, xz01, y01), bodies, slot, part, lanes);
  StoreQuarters(d, hn::InterleaveUpper(d, xz01, y01), bodies, slot + 1, part, lanes - 1);
  StoreQuarters(d, hn::InterleaveLower(d, xz23, y23), bodies, slot + 2, part, lanes - 2);
  StoreQuarters(d, hn::InterleaveUpper(d, xz23, y23), bodies, slot + 3, part, lanes - 3);
}
template <int n>
HWY_INLINE void ScatterAs(const Three<Registers<n>>& u, BodyLane* bodies, const std::int32_t* slot,
                          int part, int lanes) {
  constexpr int kHalf = n / 2 * kWidth;
  using Half = Three<Registers<n / 2>>;
  ScatterAs(Half{u.x.lo, u.y.lo, u.z.lo}, bodies, slot, part, lanes);
  ScatterAs(Half{u.x.hi, u.y.hi, u.z.hi}, bodies, slot + kHalf, part, lanes - kHalf);
}

}  // namespace HWY_NAMESPACE
}  // namespace cairn::simd
HWY_AFTER_NAMESPACE();
#endif

#endif
