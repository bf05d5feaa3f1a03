// SPDX-License-Identifier: MIT
// Vectors in space, one in every lane, and directions in planes. Compiled once per target.
#if defined(CAIRN_SIMD_LANE_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAIRN_SIMD_LANE_VECTORS_INL_H_
#undef CAIRN_SIMD_LANE_VECTORS_INL_H_
#else
#define CAIRN_SIMD_LANE_VECTORS_INL_H_
#endif

#include <hwy/highway.h>

#include "simd/pairs/pair_block.h"

HWY_BEFORE_NAMESPACE();
namespace cairn::simd {
namespace HWY_NAMESPACE {
namespace contacts {
namespace hn = hwy::HWY_NAMESPACE;

constexpr float kRootHalf = 0.70710678f;

using D = hn::CappedTag<float, kLanes>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
constexpr int kWidth = static_cast<int>(hn::MaxLanes(D()));

HWY_INLINE V Set(float value) { return hn::Set(D(), value); }
HWY_INLINE V Load(const Line& line, int l) { return hn::Load(D(), line.lane + l); }
HWY_INLINE void Store(V v, Line* line, int l) { hn::Store(v, D(), line->lane + l); }

/// Lanes of the registers that hold the first @p lanes lanes.
HWY_INLINE int InRegisters(int lanes) { return (lanes + kWidth - 1) / kWidth * kWidth; }

/// Four numbers of the first lanes, a multiple of four, from @p number on. Registers are stored
/// whole, as they are read; what is left of the last one gets numbers of the first four lanes.
#if HWY_TARGET == HWY_SCALAR
HWY_INLINE void TransposeFour(const float* const* from, int lanes, int number, Line* to) {
  for (int l = 0; l < lanes; ++l) {
    for (int k = 0; k < 4; ++k) to[k].lane[l] = from[l][number + k];
  }
}
#else
/// Four numbers of four lanes.
struct Quad {
  hn::Vec<hn::FixedTag<float, 4> > number[4];
};

HWY_INLINE Quad ReadQuad(const float* const* from, int number) {
  const hn::FixedTag<float, 4> d;
  const auto r0 = hn::LoadU(d, from[0] + number), r1 = hn::LoadU(d, from[1] + number);
  const auto r2 = hn::LoadU(d, from[2] + number), r3 = hn::LoadU(d, from[3] + number);
  const auto xy02 = hn::InterleaveLower(d, r0, r2), xy13 = hn::InterleaveLower(d, r1, r3);
  const auto zw02 = hn::InterleaveUpper(d, r0, r2), zw13 = hn::InterleaveUpper(d, r1, r3);
  return {{hn::InterleaveLower(d, xy02, xy13), hn::InterleaveUpper(d, xy02, xy13),
           hn::InterleaveLower(d, zw02, zw13), hn::InterleaveUpper(d, zw02, zw13)}};
}

/// A number of as many quads as a register holds.
template <class Lanes>
HWY_INLINE hn::Vec<Lanes> Join(Lanes d, const Quad* quads, int number) {
  if constexpr (hn::MaxLanes(Lanes()) == 4) {
    return quads->number[number];
  } else {
    const hn::Half<Lanes> half;
    return hn::Combine(d, Join(half, quads + hn::MaxLanes(half) / 4, number),
                       Join(half, quads, number));
  }
}

HWY_INLINE void TransposeFour(const float* const* from, int lanes, int number, Line* to) {
  constexpr int kQuads = kWidth / 4;
  const Quad first = ReadQuad(from, number);
  for (int l = 0; l < lanes; l += kWidth) {
    Quad quads[kQuads];
    for (int q = 0; q < kQuads; ++q) {
      const int lane = l + 4 * q;
      quads[q] = lane > 0 && lane < lanes ? ReadQuad(from + lane, number) : first;
    }
    for (int k = 0; k < 4; ++k) Store(Join(D(), quads, k), to + k, l);
  }
}
#endif

/// Four numbers of the first lanes, from @p number on: the way back.
HWY_INLINE void StoreFour(const Line* const (&from)[4], int lanes, float* const* to, int number) {
#if HWY_TARGET == HWY_SCALAR
  for (int l = 0; l < lanes; ++l) {
    for (int k = 0; k < 4; ++k) to[l][number + k] = from[k]->lane[l];
  }
#else
  const hn::FixedTag<float, 4> d;
  for (int l = 0; l < lanes; l += 4) {
    const auto x = hn::Load(d, from[0]->lane + l), y = hn::Load(d, from[1]->lane + l);
    const auto z = hn::Load(d, from[2]->lane + l), w = hn::Load(d, from[3]->lane + l);
    const auto xz01 = hn::InterleaveLower(d, x, z), yw01 = hn::InterleaveLower(d, y, w);
    const auto xz23 = hn::InterleaveUpper(d, x, z), yw23 = hn::InterleaveUpper(d, y, w);
    hn::StoreU(hn::InterleaveLower(d, xz01, yw01), d, to[l] + number);
    if (l + 1 < lanes) hn::StoreU(hn::InterleaveUpper(d, xz01, yw01), d, to[l + 1] + number);
    if (l + 2 < lanes) hn::StoreU(hn::InterleaveLower(d, xz23, yw23), d, to[l + 2] + number);
    if (l + 3 < lanes) hn::StoreU(hn::InterleaveUpper(d, xz23, yw23), d, to[l + 3] + number);
  }
#endif
}

/// A vector in space, for as many lanes as a register holds.
struct Vector {
  V x, y, z;
};
HWY_INLINE Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
HWY_INLINE Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
HWY_INLINE Vector operator*(V s, Vector a) { return {s * a.x, s * a.y, s * a.z}; }
HWY_INLINE Vector Scale(Vector a, Vector b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
HWY_INLINE V Dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
HWY_INLINE Vector Cross(Vector a, Vector b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
HWY_INLINE Vector Where(M which, Vector a, Vector b) {
  return {hn::IfThenElse(which, a.x, b.x), hn::IfThenElse(which, a.y, b.y),
          hn::IfThenElse(which, a.z, b.z)};
}
HWY_INLINE Vector At(const Line* lines, int l) {
  return {Load(lines[0], l), Load(lines[1], l), Load(lines[2], l)};
}
HWY_INLINE void Put(Vector v, Line* lines, int l) {
  Store(v.x, lines, l);
  Store(v.y, lines + 1, l);
  Store(v.z, lines + 2, l);
}

/// A unit vector across a unit vector: the first axis of its plane, of which n x it is the second.
HWY_INLINE Vector FirstAxis(Vector n) {
  const V zero = hn::Zero(D());
  const M steep = hn::Gt(hn::Abs(n.z), Set(kRootHalf));
  const V other = hn::IfThenElse(steep, n.z, n.x);
  const V k = Set(1) / hn::Sqrt(n.y * n.y + other * other);
  return Where(steep, {zero, zero - n.z * k, n.y * k}, {zero - n.y * k, n.x * k, zero});
}

/// A direction in a plane as one number, without trigonometry: its place on the square
/// |x| + |y| = 1, from 1 at (1, 0) counter-clockwise to 5.
HWY_INLINE V ToHeading(V x, V y) {
  const V along = x / (hn::Abs(x) + hn::Abs(y));
  return hn::IfThenElse(hn::Ge(y, hn::Zero(D())), Set(2) - along, Set(4) + along);
}

/// A direction in a plane.
struct Heading {
  V x, y;
  M known;  ///< else it is (1, 0), and the second direction is the second axis
};
HWY_INLINE Heading FromHeading(V heading) {
  const V one = Set(1), zero = hn::Zero(D());
  const M upper = hn::Lt(heading, Set(3));
  const V x = hn::IfThenElse(upper, Set(2) - heading, heading - Set(4));
  const V left = one - hn::Abs(x);
  const V y = hn::IfThenElse(upper, left, zero - left);
  const M known = hn::And(hn::Ge(heading, one), hn::Le(heading, Set(5)));
  const V length = hn::Sqrt(hn::IfThenElse(known, x * x + y * y, one));
  return {hn::IfThenElse(known, x / length, one), hn::IfThenElse(known, y / length, zero), known};
}

}  // namespace contacts
}  // namespace HWY_NAMESPACE
}  // namespace cairn::simd
HWY_AFTER_NAMESPACE();

#endif
