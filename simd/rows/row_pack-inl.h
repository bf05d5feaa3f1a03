// SPDX-License-Identifier: MIT
// Rows of a block from double precision to whitened floats. Compiled once per target.
#if defined(CAIRN_SIMD_ROW_PACK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAIRN_SIMD_ROW_PACK_INL_H_
#undef CAIRN_SIMD_ROW_PACK_INL_H_
#else
#define CAIRN_SIMD_ROW_PACK_INL_H_
#endif

#include <hwy/highway.h>

#include "simd/rows/row_pack.h"

HWY_BEFORE_NAMESPACE();
namespace cairn::simd {
namespace HWY_NAMESPACE {
namespace rows {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, 4>;
using V = hn::Vec<D>;
constexpr int kWidth = static_cast<int>(hn::MaxLanes(D()));

/// As in contact_bodies-inl.h.
constexpr double kMost = 1e12, kLeast = 1e-18, kMostTarget = 1e18, kMostEnergy = 1e30;

/// The six numbers of one side, of as many lanes as a register holds.
struct Side {
  V j[6];
};

#if HWY_TARGET == HWY_SCALAR
HWY_INLINE Side LoadSide(const double* const* from) {
  const D d;
  return {{hn::Load(d, from[0]), hn::Load(d, from[0] + 1), hn::Load(d, from[0] + 2),
           hn::Load(d, from[0] + 3), hn::Load(d, from[0] + 4), hn::Load(d, from[0] + 5)}};
}
#else
/// Whole loads and a transpose.
HWY_INLINE Side LoadSide(const double* const* from) {
  const D d;
  Side side;
  if constexpr (kWidth == 4) {
    // numbers 0 to 3, then 2 to 5 of which the last two are new
    const V r0 = hn::LoadU(d, from[0]), r1 = hn::LoadU(d, from[1]);
    const V r2 = hn::LoadU(d, from[2]), r3 = hn::LoadU(d, from[3]);
    const V even01 = hn::InterleaveLower(d, r0, r1), odd01 = hn::InterleaveUpper(d, r0, r1);
    const V even23 = hn::InterleaveLower(d, r2, r3), odd23 = hn::InterleaveUpper(d, r2, r3);
    side.j[0] = hn::ConcatLowerLower(d, even23, even01);
    side.j[1] = hn::ConcatLowerLower(d, odd23, odd01);
    side.j[2] = hn::ConcatUpperUpper(d, even23, even01);
    side.j[3] = hn::ConcatUpperUpper(d, odd23, odd01);
    const V q0 = hn::LoadU(d, from[0] + 2), q1 = hn::LoadU(d, from[1] + 2);
    const V q2 = hn::LoadU(d, from[2] + 2), q3 = hn::LoadU(d, from[3] + 2);
    side.j[4] =
        hn::ConcatUpperUpper(d, hn::InterleaveLower(d, q2, q3), hn::InterleaveLower(d, q0, q1));
    side.j[5] =
        hn::ConcatUpperUpper(d, hn::InterleaveUpper(d, q2, q3), hn::InterleaveUpper(d, q0, q1));
  } else {
    for (int k = 0; k < 6; k += 2) {
      const V r0 = hn::LoadU(d, from[0] + k), r1 = hn::LoadU(d, from[1] + k);
      side.j[k] = hn::InterleaveLower(d, r0, r1);
      side.j[k + 1] = hn::InterleaveUpper(d, r0, r1);
    }
  }
  return side;
}
#endif

HWY_INLINE V At(const DoubleLine& line, int lane) { return hn::Load(D(), line.lane + lane); }

HWY_INLINE void Put(V value, Line* line, int lane) {
  const hn::Rebind<float, D> f;
  hn::StoreU(hn::DemoteTo(f, value), f, line->lane + lane);
}

/// J v
HWY_INLINE V Velocity(const Side& side, const BodyLines& body, int lane) {
  V linear = hn::Mul(side.j[0], At(body.velocity[0], lane));
  V angular = hn::Mul(side.j[3], At(body.velocity[3], lane));
  for (int k = 1; k < 3; ++k) {
    linear = hn::Add(linear, hn::Mul(side.j[k], At(body.velocity[k], lane)));
    angular = hn::Add(angular, hn::Mul(side.j[3 + k], At(body.velocity[3 + k], lane)));
  }
  return hn::Add(linear, angular);
}

/// G = J R of one side; returns |G|^2.
HWY_INLINE V Whiten(const Side& side, const BodyLines& body, int lane, V* g) {
  V sum = hn::Zero(D());
  for (int k = 0; k < 3; ++k) {
    g[k] = hn::Mul(side.j[k], At(body.linear[k], lane));
    const DoubleLine* const column = body.angular + 3 * k;
    const V x = hn::Mul(side.j[3], At(column[0], lane));
    const V y = hn::Mul(side.j[4], At(column[1], lane));
    const V z = hn::Mul(side.j[5], At(column[2], lane));
    g[3 + k] = hn::Add(hn::Add(x, y), z);
    sum = hn::Add(sum, hn::Add(hn::Mul(g[k], g[k]), hn::Mul(g[3 + k], g[3 + k])));
  }
  return sum;
}

/// Zero, or not a number if one of the side is not finite.
HWY_INLINE V FiniteCheck(const Side& side) {
  const V zero = hn::Zero(D());
  V sum = hn::Mul(side.j[0], zero);
  for (int k = 1; k < 6; ++k) sum = hn::Add(sum, hn::Mul(side.j[k], zero));
  return sum;
}

template <PairForm form>
HWY_INLINE bool PackLanes(const SourceRows& rows, const BodyLines& body_a, const BodyLines& body_b,
                          int lane, Line* out) {
  const D d;
  const Side a = LoadSide(rows.a + lane), b = LoadSide(rows.b + lane);
  V g_a[6], g_b[6];
  V diagonal = Whiten(a, body_a, lane, g_a);
  V target = hn::Sub(At(rows.target, lane), Velocity(a, body_a, lane));
  if constexpr (form == PairForm::kSingle) {
    target = hn::Add(target, FiniteCheck(b));
  } else {
    diagonal = hn::Add(diagonal, Whiten(b, body_b, lane, g_b));
    target = hn::Sub(target, Velocity(b, body_b, lane));
  }
  diagonal = hn::Add(diagonal, At(rows.compliance, lane));

  const V zero = hn::Zero(d), one = hn::Set(d, 1.0);
  const auto satisfiable = hn::Gt(diagonal, zero);
  const V divisor = hn::IfThenElse(satisfiable, diagonal, one);
  const V step = hn::IfThenElse(satisfiable, hn::Div(At(rows.relaxation, lane), divisor), one);
  // comparisons with what is not a number are false
  const auto target_fits =
      hn::And(hn::Le(hn::Abs(target), hn::Set(d, kMostTarget)),
              hn::Le(hn::Mul(target, target), hn::Mul(hn::Set(d, kMostEnergy), divisor)));
  const auto fits = hn::And(hn::And(target_fits, hn::Le(diagonal, hn::Set(d, kMost))),
                            hn::Or(hn::Ge(diagonal, hn::Set(d, kLeast)), hn::Eq(diagonal, zero)));

  if constexpr (form == PairForm::kContact) {
    const V s_a = At(body_a.linear[0], lane), s_b = At(body_b.linear[0], lane);
    const V r = hn::Sqrt(hn::Add(hn::Mul(s_a, s_a), hn::Mul(s_b, s_b)));
    for (int k = 0; k < 3; ++k) Put(hn::Mul(r, a.j[k]), out++, lane);
  } else {
    for (int k = 0; k < 3; ++k) Put(g_a[k], out++, lane);
  }
  for (int k = 3; k < 6; ++k) Put(g_a[k], out++, lane);
  if constexpr (form == PairForm::kJoint) {
    for (int k = 0; k < 3; ++k) Put(g_b[k], out++, lane);
  }
  if constexpr (form != PairForm::kSingle) {
    for (int k = 3; k < 6; ++k) Put(g_b[k], out++, lane);
  }
  Put(hn::IfThenElseZero(satisfiable, target), out++, lane);
  Put(step, out, lane);
  return hn::AllTrue(d, fits);
}

template <PairForm form>
HWY_INLINE bool PackForm(const SourceRows& rows, const BodyLines& a, const BodyLines& b,
                         Line* out) {
  bool fits = true;
  for (int lane = 0; lane < kLanes; lane += kWidth) {
    fits = PackLanes<form>(rows, a, b, lane, out) && fits;
  }
  return fits;
}

inline bool PackRow(PairForm form, const SourceRows& rows, const BodyLines& a, const BodyLines& b,
                    Line* out) {
  switch (form) {
    case PairForm::kJoint:
      return PackForm<PairForm::kJoint>(rows, a, b, out);
    case PairForm::kContact:
      return PackForm<PairForm::kContact>(rows, a, b, out);
    case PairForm::kSingle:
      return PackForm<PairForm::kSingle>(rows, a, b, out);
  }
  return false;
}

}  // namespace rows
}  // namespace HWY_NAMESPACE
}  // namespace cairn::simd
HWY_AFTER_NAMESPACE();

#endif
