// SPDX-License-Identifier: MIT
// The first 4, 8 or 16 floats of lines as one to four registers, and bodies gathered into them.
// Compiled once per target.
#if defined(CAIRN_SIMD_WIDE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAIRN_SIMD_WIDE_INL_H_
#undef CAIRN_SIMD_WIDE_INL_H_
#else
#define CAIRN_SIMD_WIDE_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include "simd/pairs/pair_block.h"

// Code without vectors is simd/pairs/pair_reference.cc.
#if HWY_TARGET != HWY_SCALAR
HWY_BEFORE_NAMESPACE();
namespace cairn::simd {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Floats of one register.
template <class D>
constexpr int kWidth = static_cast<int>(hn::MaxLanes(D()));

/// Registers as a tree, so that the compiler sees values and never an array: each operation is done
/// on all registers before the next, which gives the core independent chains to work on.
template <class D, int n>
struct Registers {
  static constexpr int kRegisters = n, kLaneCount = n * kWidth<D>;
  Registers<D, n / 2> lo, hi;
};
template <class D>
struct Registers<D, 1> {
  static constexpr int kRegisters = 1, kLaneCount = kWidth<D>;
  hn::Vec<D> v;
};
/// The first @p lanes floats of a line.
template <int lanes, class D = hn::CappedTag<float, lanes>>
using Wide = Registers<D, lanes / kWidth<D>>;

#define CAIRN_BINARY(NAME)                                                              \
  template <class D>                                                                    \
  HWY_INLINE Registers<D, 1> NAME(const Registers<D, 1>& a, const Registers<D, 1>& b) { \
    return {hn::NAME(a.v, b.v)};                                                        \
  }                                                                                     \
  template <class D, int n>                                                             \
  HWY_INLINE Registers<D, n> NAME(const Registers<D, n>& a, const Registers<D, n>& b) { \
    return {NAME(a.lo, b.lo), NAME(a.hi, b.hi)};                                        \
  }
CAIRN_BINARY(Add)
CAIRN_BINARY(Sub)
CAIRN_BINARY(Mul)
CAIRN_BINARY(Div)
CAIRN_BINARY(Min)
CAIRN_BINARY(Max)
#undef CAIRN_BINARY

/// Lines from a lane on: the numbers of a run.
struct FromLane {
  float* lane;

  HWY_INLINE float* operator[](int line) const { return lane + line * kLanes; }
};
struct ConstFromLane {
  const float* lane;

  HWY_INLINE const float* operator[](int line) const { return lane + line * kLanes; }
  HWY_INLINE void operator+=(int lines) { lane += lines * kLanes; }
  HWY_INLINE ConstFromLane operator+(int lines) const { return {lane + lines * kLanes}; }
};

/// Registers of whole lines are aligned, those of runs may begin at any lane.
template <bool aligned, class D>
HWY_INLINE void LoadFrom(const float* from, Registers<D, 1>* a) {
  if constexpr (aligned) {
    a->v = hn::Load(D(), from);
  } else {
    a->v = hn::LoadU(D(), from);
  }
}
template <bool aligned, class D, int n>
HWY_INLINE void LoadFrom(const float* from, Registers<D, n>* a) {
  LoadFrom<aligned>(from, &a->lo);
  LoadFrom<aligned>(from + n / 2 * kWidth<D>, &a->hi);
}
template <class W>
HWY_INLINE W LoadLanes(const float* from) {
  W a;
  LoadFrom<W::kLaneCount == kLanes>(from, &a);
  return a;
}

template <bool aligned, class D>
HWY_INLINE void StoreTo(float* to, const Registers<D, 1>& a) {
  if constexpr (aligned) {
    hn::Store(a.v, D(), to);
  } else {
    hn::StoreU(a.v, D(), to);
  }
}
template <bool aligned, class D, int n>
HWY_INLINE void StoreTo(float* to, const Registers<D, n>& a) {
  StoreTo<aligned>(to, a.lo);
  StoreTo<aligned>(to + n / 2 * kWidth<D>, a.hi);
}
template <class W>
HWY_INLINE void StoreLanes(const W& a, float* to) {
  StoreTo<W::kLaneCount == kLanes>(to, a);
}

/// Which lanes are the first few.
template <class D, int n>
struct FirstLanes {
  FirstLanes<D, n / 2> lo, hi;

  HWY_INLINE explicit FirstLanes(int lanes) : lo(lanes), hi(lanes - n / 2 * kWidth<D>) {}
  HWY_INLINE Registers<D, n> Choose(const Registers<D, n>& first,
                                    const Registers<D, n>& others) const {
    return {lo.Choose(first.lo, others.lo), hi.Choose(first.hi, others.hi)};
  }
};
template <class D>
struct FirstLanes<D, 1> {
  hn::Mask<D> mask;

  HWY_INLINE explicit FirstLanes(int lanes)
      : mask(hn::FirstN(D(), lanes > 0 ? static_cast<std::size_t>(lanes) : 0)) {}
  HWY_INLINE Registers<D, 1> Choose(const Registers<D, 1>& first,
                                    const Registers<D, 1>& others) const {
    return {hn::IfThenElse(mask, first.v, others.v)};
  }
};
template <class W>
struct FirstLanesFor;
template <class D, int n>
struct FirstLanesFor<Registers<D, n>> {
  using Type = FirstLanes<D, n>;
};

template <class D>
HWY_INLINE void Clear(Registers<D, 1>* a) {
  a->v = hn::Zero(D());
}
template <class D, int n>
HWY_INLINE void Clear(Registers<D, n>* a) {
  Clear(&a->lo);
  Clear(&a->hi);
}
template <class W>
HWY_INLINE W Zeros() {
  W a;
  Clear(&a);
  return a;
}

template <class D>
HWY_INLINE Registers<D, 1> Abs(const Registers<D, 1>& a) {
  return {hn::Abs(a.v)};
}
/// a where b > 0, else 0.
template <class D>
HWY_INLINE Registers<D, 1> WherePositive(const Registers<D, 1>& a, const Registers<D, 1>& b) {
  return {hn::IfThenElseZero(hn::Gt(b.v, hn::Zero(D())), a.v)};
}
template <class D, int n>
HWY_INLINE Registers<D, n> Abs(const Registers<D, n>& a) {
  return {Abs(a.lo), Abs(a.hi)};
}
template <class D, int n>
HWY_INLINE Registers<D, n> WherePositive(const Registers<D, n>& a, const Registers<D, n>& b) {
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
/// Beyond the first @p lanes lanes, and those that are read with them, numbers are any of bodies,
/// or 0. Few lanes, as blocks of small worlds have, take a third of the time.
template <class D>
HWY_INLINE void GatherTo(const BodyLane* bodies, const std::int32_t* slot, int part, int lanes,
                         Registers<D, 1>* x, Registers<D, 1>* y, Registers<D, 1>* z) {
  const D d;
  hn::Vec<D> r0, r1, r2, r3;
  if constexpr (kWidth<D> == 4) {
    if (lanes == 1) {  // a body with many neighbours has one pair a run
      x->v = LoadQuarter(d, bodies, slot[0], part);
      y->v = hn::Shuffle2301(x->v);
      z->v = hn::Shuffle1032(x->v);
      return;
    }
  }
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
  const auto xy02 = hn::InterleaveLower(d, r0, r2), xy13 = hn::InterleaveLower(d, r1, r3);
  const auto zw02 = hn::InterleaveUpper(d, r0, r2), zw13 = hn::InterleaveUpper(d, r1, r3);
  x->v = hn::InterleaveLower(d, xy02, xy13);
  y->v = hn::InterleaveUpper(d, xy02, xy13);
  z->v = hn::InterleaveLower(d, zw02, zw13);
}
template <class D, int n>
HWY_INLINE void GatherTo(const BodyLane* bodies, const std::int32_t* slot, int part, int lanes,
                         Registers<D, n>* x, Registers<D, n>* y, Registers<D, n>* z) {
  constexpr int kHalf = n / 2 * kWidth<D>;
  GatherTo(bodies, slot, part, lanes, &x->lo, &y->lo, &z->lo);
  GatherTo(bodies, slot + kHalf, part, lanes - kHalf, &x->hi, &y->hi, &z->hi);
}
template <class W>
HWY_INLINE Three<W> GatherBodies(const BodyLane* bodies, const std::int32_t* slot, int part,
                                 int lanes) {
  Three<W> u;
  GatherTo(bodies, slot, part, lanes, &u.x, &u.y, &u.z);
  return u;
}

template <class D>
HWY_INLINE void ScatterFrom(const Registers<D, 1>& x, const Registers<D, 1>& y,
                            const Registers<D, 1>& z, BodyLane* bodies, const std::int32_t* slot,
                            int part, int lanes) {
  const D d;
  const auto zero = hn::Zero(d);
  const auto xz01 = hn::InterleaveLower(d, x.v, z.v), y01 = hn::InterleaveLower(d, y.v, zero);
  const auto xz23 = hn::InterleaveUpper(d, x.v, z.v), y23 = hn::InterleaveUpper(d, y.v, zero);
  // within a block of four: the step between lanes of one register is 1
  StoreQuarters(d, hn::InterleaveLower(d, xz01, y01), bodies, slot, part, lanes);
  StoreQuarters(d, hn::InterleaveUpper(d, xz01, y01), bodies, slot + 1, part, lanes - 1);
  StoreQuarters(d, hn::InterleaveLower(d, xz23, y23), bodies, slot + 2, part, lanes - 2);
  StoreQuarters(d, hn::InterleaveUpper(d, xz23, y23), bodies, slot + 3, part, lanes - 3);
}
template <class D, int n>
HWY_INLINE void ScatterFrom(const Registers<D, n>& x, const Registers<D, n>& y,
                            const Registers<D, n>& z, BodyLane* bodies, const std::int32_t* slot,
                            int part, int lanes) {
  constexpr int kHalf = n / 2 * kWidth<D>;
  ScatterFrom(x.lo, y.lo, z.lo, bodies, slot, part, lanes);
  ScatterFrom(x.hi, y.hi, z.hi, bodies, slot + kHalf, part, lanes - kHalf);
}
/// Writes what GatherBodies() read, for the first @p lanes lanes.
template <class W>
HWY_INLINE void ScatterBodies(const Three<W>& u, BodyLane* bodies, const std::int32_t* slot,
                              int part, int lanes) {
  ScatterFrom(u.x, u.y, u.z, bodies, slot, part, lanes);
}

}  // namespace HWY_NAMESPACE
}  // namespace cairn::simd
HWY_AFTER_NAMESPACE();
#endif

#endif
