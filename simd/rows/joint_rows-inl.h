// SPDX-License-Identifier: MIT
// Rows of joints, as many lanes at a time as a register holds. Compiled once per target.
#if defined(CAIRN_SIMD_JOINT_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAIRN_SIMD_JOINT_ROWS_INL_H_
#undef CAIRN_SIMD_JOINT_ROWS_INL_H_
#else
#define CAIRN_SIMD_JOINT_ROWS_INL_H_
#endif

#include <hwy/highway.h>

#include <limits>

#include "simd/rows/contact_bodies-inl.h"
#include "simd/rows/joint_rows.h"

HWY_BEFORE_NAMESPACE();
namespace cairn::simd {
namespace HWY_NAMESPACE {
namespace contacts {
namespace hn = hwy::HWY_NAMESPACE;

/// One side of a row.
struct JointSide {
  Vector linear, angular;
};

template <PairForm form>
class JointPacker {
 public:
  JointPacker(const JointLanes& lanes, Line* out, Line* x)
      : lanes_(lanes), end_(InRegisters(lanes.lanes)), out_(out), x_(x) {
    Gather(lanes.a, lanes.lanes, &a_);
    Gather(lanes.b, lanes.lanes, &b_);
    for (int l = 0; l < lanes.lanes; ++l) {
      damping_.lane[l] = lanes.damping[l];
      opposite_.lane[l] = lanes.opposite[l] ? 1 : 0;
      second_moves_.lane[l] = lanes.second_moves[l] ? 1 : 0;
    }
    for (Line* line : {&damping_, &opposite_, &second_moves_}) FillRegisters(lanes.lanes, line);
    if constexpr (form == PairForm::kSingle) {
      const ContactBody* moving[kLanes];
      for (int l = 0; l < lanes.lanes; ++l) {
        moving[l] = lanes.second_moves[l] ? lanes.b[l] : lanes.a[l];
      }
      Gather(moving, lanes.lanes, &moving_);
    }
  }

  bool Pack() {
    if constexpr (form == PairForm::kContact) {
      PutPair(a_, b_, end_, out_, &scale_);
      out_ += PairLines(form);
    }
    for (int i = 0; i < lanes_.row_count; ++i) {
      Read(i);
      const RowShape& shape = lanes_.rows[i];
      Line* const behind = out_ + JacobianLines(form);
      for (int l = 0; l < end_; l += kWidth) PutRow(shape.soft, l, behind);
      out_ = behind + 2;
      if (shape.soft) *out_++ = number_[kRowCompliance];
      if (shape.bound == RowBound::kOwn) {
        PutBounds(x_ + i);
      } else {
        x_[i] = start_;
      }
      ++out_;  // the coupling
    }
    return fits_;
  }

 private:
  void Read(int i) {
    const float* numbers[kLanes];
    for (int l = 0; l < lanes_.lanes; ++l) {
      numbers[l] = lanes_.row[l] + i * kJointNumbers;
      start_.lane[l] = lanes_.start[l][i];
    }
    for (int k = 0; k < kJointNumbers; k += 4) {
      TransposeFour(numbers, lanes_.lanes, k, number_ + k);
    }
    for (int l = 0; l < end_; l += kWidth) {
      // one side says it for both
      const M opposite = hn::Gt(Load(opposite_, l), hn::Zero(D()));
      const Vector a = At(number_ + kLinearA, l), b = At(number_ + kLinearB, l);
      Put(Where(opposite, Set(-1) * a, b), number_ + kLinearB, l);
    }
  }

  void Demand(M fits) { fits_ = hn::AllTrue(D(), fits) && fits_; }

  /// What the bodies do along a side without constraints.
  HWY_INLINE V Free(const JointSide& side, const Bodies& bodies, int l) const {
    return Dot(side.linear, bodies.free_velocity(l)) + Dot(side.angular, bodies.free_spin(l));
  }

  /// Writes G of one side, of PairForm::kContact only what turns; returns |G|^2.
  HWY_INLINE V PutSide(const JointSide& side, const Bodies& bodies, int l, Line* linear,
                       Line* angular) const {
    const Vector g = Scale(side.linear, bodies.linear(l)), turn = bodies.Whiten(side.angular, l);
    if (linear != nullptr) Put(g, linear, l);
    Put(turn, angular, l);
    return Dot(g, g) + Dot(turn, turn);
  }

  /// G, target and step of one row.
  HWY_INLINE void PutRow(bool soft, int l, Line* behind) {
    const JointSide a{At(number_ + kLinearA, l), At(number_ + kAngularA, l)};
    const JointSide b{At(number_ + kLinearB, l), At(number_ + kAngularB, l)};
    V diagonal;
    if constexpr (form == PairForm::kSingle) {
      const M second = hn::Gt(Load(second_moves_, l), hn::Zero(D()));
      const JointSide side{Where(second, b.linear, a.linear), Where(second, b.angular, a.angular)};
      diagonal = PutSide(side, moving_, l, out_, out_ + 3);
    } else if constexpr (form == PairForm::kContact) {
      Put(Load(scale_, l) * a.linear, out_, l);
      diagonal = PutSide(a, a_, l, nullptr, out_ + 3);
      diagonal = diagonal + PutSide(b, b_, l, nullptr, out_ + 6);
    } else {
      diagonal = PutSide(a, a_, l, out_, out_ + 3);
      diagonal = diagonal + PutSide(b, b_, l, out_ + 6, out_ + 9);
    }
    if (soft) {
      const V compliance = Load(number_[kRowCompliance], l);
      diagonal = diagonal + compliance;
      Demand(hn::Ge(compliance, hn::Zero(D())));
    }
    const V free = Free(a, a_, l) + Free(b, b_, l);
    const V target = Load(number_[kTarget], l) - Load(damping_, l) * free;
    Demand(PutStep(target, diagonal, l, behind));
    Demand(hn::Le(hn::Abs(Load(start_, l)), Set(kMost)));
  }

  /// Bounds, and the start inside them.
  void PutBounds(Line* x) {
    constexpr float kEndless = std::numeric_limits<float>::infinity();
    for (int l = 0; l < end_; l += kWidth) {
      const V lo = Load(number_[kLo], l), hi = Load(number_[kHi], l);
      // + 0: no bound may leave a -0
      Store(hn::Min(hn::Max(Load(start_, l), lo), hi) + hn::Zero(D()), x, l);
      // comparisons with what is not a number are false
      Demand(
          hn::And(hn::Le(lo, hi), hn::And(hn::Lt(lo, Set(kEndless)), hn::Gt(hi, Set(-kEndless)))));
    }
    *out_++ = number_[kLo];
    *out_++ = number_[kHi];
  }

  const JointLanes& lanes_;
  const int end_;  ///< Of the registers that hold them.
  Line* out_;
  Line* x_;
  Bodies a_, b_, moving_;  ///< moving_: of PairForm::kSingle
  Line scale_;             ///< of PairForm::kContact, see PutPair()
  Line damping_ = {};
  Line opposite_ = {}, second_moves_ = {};   ///< 1 where that is so, else 0
  Line number_[kJointNumbers], start_ = {};  ///< of the row
  bool fits_ = true;
};

inline bool PackJoints(const JointLanes& lanes, Line* out, Line* x) {
  switch (lanes.form) {
    case PairForm::kJoint:
      return JointPacker<PairForm::kJoint>(lanes, out, x).Pack();
    case PairForm::kContact:
      return JointPacker<PairForm::kContact>(lanes, out, x).Pack();
    case PairForm::kSingle:
      return JointPacker<PairForm::kSingle>(lanes, out, x).Pack();
  }
  return false;
}

}  // namespace contacts
}  // namespace HWY_NAMESPACE
}  // namespace cairn::simd
HWY_AFTER_NAMESPACE();

#endif
