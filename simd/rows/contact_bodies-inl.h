// SPDX-License-Identifier: MIT
// The bodies of a block as its rows see them, transposed. Compiled once per target.
#if defined(CAIRN_SIMD_CONTACT_BODIES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAIRN_SIMD_CONTACT_BODIES_INL_H_
#undef CAIRN_SIMD_CONTACT_BODIES_INL_H_
#else
#define CAIRN_SIMD_CONTACT_BODIES_INL_H_
#endif

#include <hwy/highway.h>

#include "simd/lane_vectors-inl.h"
#include "simd/rows/contact_body.h"

HWY_BEFORE_NAMESPACE();
namespace cairn::simd {
namespace HWY_NAMESPACE {
namespace contacts {
namespace hn = hwy::HWY_NAMESPACE;

/// Impulses, coefficients and d up to kMost, d from kLeast on, and the energy of a row up to
/// kMostEnergy are held by floats with all that sweeps make of them: the square of a velocity u is
/// at most that energy, or d x^2.
constexpr float kMost = 1e12f, kLeast = 1e-18f, kMostEnergy = 1e30f;

/// The bodies of all lanes, ContactBody by number.
struct Bodies {
  Line number[kContactBodyNumbers];
  HWY_INLINE Vector linear(int l) const { return At(number, l); }
  HWY_INLINE Vector free_velocity(int l) const { return At(number + 12, l); }
  HWY_INLINE Vector free_spin(int l) const { return At(number + 15, l); }
  HWY_INLINE Vector start_velocity(int l) const { return At(number + 18, l); }
  HWY_INLINE Vector start_spin(int l) const { return At(number + 21, l); }
  /// R' of an angular vector.
  HWY_INLINE Vector Whiten(Vector c, int l) const {
    return {Dot(At(number + 3, l), c), Dot(At(number + 6, l), c), Dot(At(number + 9, l), c)};
  }
};

/// @p lanes  of which there are bodies, a multiple of four
HWY_INLINE void Gather(const ContactBody* const* from, int lanes, Bodies* bodies) {
  const float* numbers[kLanes];
  for (int l = 0; l < lanes; ++l) numbers[l] = from[l]->linear;
  for (int k = 0; k < kContactBodyNumbers; k += 4) {
    TransposeFour(numbers, lanes, k, bodies->number + k);
  }
}

/// Fills a line up to the end of a register, as TransposeFour() does: what is beyond @p lanes, a
/// multiple of four, must be as good as the first four lanes, or wide registers refuse what narrow
/// ones take.
HWY_INLINE void FillRegisters(int lanes, Line* line) {
  for (int l = lanes; l < InRegisters(lanes); ++l) line->lane[l] = line->lane[l % 4];
}

/// Writes the lines of a pair of PairForm::kContact up to lane @p end; @p scale: r, by which
/// directions are scaled.
HWY_INLINE void PutPair(const Bodies& a, const Bodies& b, int end, Line* out, Line* scale) {
  const V zero = hn::Zero(D());
  for (int l = 0; l < end; l += kWidth) {
    const V s_a = Load(a.number[0], l), s_b = Load(b.number[0], l);
    const V r = hn::Sqrt(s_a * s_a + s_b * s_b);
    const M moves = hn::Gt(r, zero);
    const V divisor = hn::IfThenElse(moves, r, Set(1));
    Store(s_a / divisor, out, l);
    Store(s_b / divisor, out + 1, l);
    Store(r, scale, l);
  }
}

/// Writes target and step 1 / d of a row whose other lines are there. A row with d = 0, which
/// nothing can satisfy, asks for nothing. False in lanes that do not fit a float with its square,
/// or are not finite.
HWY_INLINE M PutStep(V target, V diagonal, int l, Line* out) {
  const V zero = hn::Zero(D()), one = Set(1);
  const M satisfiable = hn::Gt(diagonal, zero);
  const V step = one / hn::IfThenElse(satisfiable, diagonal, one);
  Store(hn::IfThenElseZero(satisfiable, target), out, l);
  Store(step, out + 1, l);
  // comparisons with what is not a number are false; squares of targets beyond 1e19 are infinite
  const M target_fits = hn::Le(target * target * step, Set(kMostEnergy));
  return hn::And(hn::And(target_fits, hn::Le(diagonal, Set(kMost))),
                 hn::Or(hn::Ge(diagonal, Set(kLeast)), hn::Eq(diagonal, zero)));
}

}  // namespace contacts
}  // namespace HWY_NAMESPACE
}  // namespace cairn::simd
HWY_AFTER_NAMESPACE();

#endif
