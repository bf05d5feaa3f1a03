// SPDX-License-Identifier: MIT
// Rows of contacts from their points, as many lanes at a time as a register holds. Compiled once
// per target.
#if defined(CAIRN_SIMD_CONTACT_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAIRN_SIMD_CONTACT_ROWS_INL_H_
#undef CAIRN_SIMD_CONTACT_ROWS_INL_H_
#else
#define CAIRN_SIMD_CONTACT_ROWS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "simd/rows/contact_bodies-inl.h"
#include "simd/rows/contact_rows.h"

HWY_BEFORE_NAMESPACE();
namespace cairn::simd {
namespace HWY_NAMESPACE {
namespace contacts {
namespace hn = hwy::HWY_NAMESPACE;

/// Points that slide slower have no direction [m^2/s^2].
constexpr float kLeastSlide = 1.1920929e-7f;

/// One point of all lanes: what was read, and what its rows have in common.
struct Point {
  Line number[kPointNumbers];
  Line start[kStartNumbers];
  Line axis[3];  ///< the first of the plane across the normal
  Line t1[3], t2[3];
  Line heading;   ///< of t1
  Line across;    ///< coefficient of friction along t2
  Line slide[3];  ///< relative velocity that friction works against
  Line wanted;    ///< along the normal, relative to the velocity without constraints
  Line x[3];      ///< start impulses
};

/// What resists turning at one point of all lanes.
struct Twist {
  Line number[kTwistNumbers];
  Line start[kTwistRows] = {};
  Line axis[kTwistRows][3];
};

/// What the rows of a point do to its bodies.
enum class Acts { kPush, kTurn };

template <PairForm form>
class Packer {
 public:
  Packer(const ContactLanes& lanes, Line* out, Line* x)
      : lanes_(lanes), end_(InRegisters(lanes.lanes)), out_(out), x_(x) {
    Gather(lanes.a, lanes.lanes, &a_);
    Gather(lanes.b, lanes.lanes, &b_);
    if constexpr (form == PairForm::kSingle) {
      const ContactBody* moving[kLanes];
      for (int l = 0; l < lanes.lanes; ++l) {
        moving[l] = lanes.second_moves[l] ? lanes.b[l] : lanes.a[l];
        sign_.lane[l] = lanes.second_moves[l] ? -1.0f : 1.0f;
      }
      FillRegisters(lanes.lanes, &sign_);
      Gather(moving, lanes.lanes, &moving_);
    }
  }

  bool Pack(Line* directions) {
    if constexpr (form == PairForm::kContact) {
      PutPair(a_, b_, end_, out_, &scale_);
      out_ += PairLines(form);
    }
    Point points[kMostPoints];
    for (int p = 0; p < lanes_.points; ++p) {
      Read(p, &points[p]);
      for (int l = 0; l < end_; l += kWidth) {
        Aim(l, &points[p]);
        Start(l, &points[p]);
      }
      PutNormal(points[p], x_ + p);
    }
    for (int p = 0; p < lanes_.points && lanes_.tangents > 0; ++p) {
      Line* const x = x_ + lanes_.points + p * lanes_.tangents;
      PutFriction(points[p], points[p].t1, points[p].number[kFriction], points[p].x[1], x);
      if (lanes_.tangents > 1)
        PutFriction(points[p], points[p].t2, points[p].across, points[p].x[2], x + 1);
      for (int k = 0; k < 3; ++k) directions[kDirectionLines * p + k] = points[p].t1[k];
      directions[kDirectionLines * p + 3] = points[p].heading;
    }
    Line* x = x_ + lanes_.points * (1 + lanes_.tangents);
    for (int p = 0; p < lanes_.points && lanes_.twists; ++p) {
      Twist twist;
      ReadTwist(p, points[p], &twist);
      for (int k = 0; k < kTwistRows; ++k) PutTwist(points[p], twist, k, x++);
    }
    return fits_;
  }

 private:
  void Read(int p, Point* point) const {
    const float *numbers[kLanes], *starts[kLanes];
    for (int l = 0; l < lanes_.lanes; ++l) {
      numbers[l] = lanes_.point[l] + p * kPointNumbers;
      starts[l] = lanes_.start[l] + p * kStartStride;
    }
    for (int k = 0; k < kPointNumbers; k += 4) {
      TransposeFour(numbers, lanes_.lanes, k, point->number + k);
    }
    TransposeFour(starts, lanes_.lanes, 0, point->start);
  }

  void Demand(M fits) { fits_ = hn::AllTrue(D(), fits) && fits_; }

  /// Directions, and velocities along them.
  HWY_INLINE void Aim(int l, Point* point) const {
    const V zero = hn::Zero(D());
    const Vector n = At(point->number + kNormal, l);
    const Vector arm_a = At(point->number + kArmA, l), arm_b = At(point->number + kArmB, l);
    const Vector straight = a_.free_velocity(l) - b_.free_velocity(l);
    const Vector turning = Cross(a_.free_spin(l), arm_a) - Cross(b_.free_spin(l), arm_b);
    const Vector turned = Cross(a_.start_spin(l), arm_a) - Cross(b_.start_spin(l), arm_b);
    const Vector free = straight + turning;
    const Vector start = a_.start_velocity(l) - b_.start_velocity(l) + turned;

    // what is slow does not bounce
    const V approach = zero - Dot(n, start), along = Dot(n, free);
    const M bounces = hn::Ge(hn::Abs(approach), Set(lanes_.bounce_speed));
    const V bounce = hn::Max(Load(point->number[kRestitution], l) * approach, zero);
    const V wanted = Load(point->number[kBias], l) + hn::IfThenElseZero(bounces, bounce) - along;
    Store(wanted, &point->wanted, l);

    const Vector axis = FirstAxis(n), slide = free - along * n;
    const V square = Dot(slide, slide);
    const M slides = hn::Gt(square, Set(kLeastSlide));
    const V per_length = Set(1) / hn::Sqrt(hn::IfThenElse(slides, square, Set(1)));
    const Vector given = At(point->number + kTangent, l);
    const M is_given = hn::Gt(hn::Abs(given.x) + hn::Abs(given.y) + hn::Abs(given.z), zero);
    const Vector t1 = Where(is_given, given, Where(slides, per_length * slide, axis));
    Put(axis, point->axis, l);
    Put(t1, point->t1, l);
    Put(Cross(t1, n), point->t2, l);
    Store(ToHeading(Dot(t1, axis), Dot(t1, Cross(n, axis))), &point->heading, l);
    Put(straight + (lanes_.spin_before_torques ? turned : turning), point->slide, l);

    const V friction = Load(point->number[kFriction], l);
    const V stopped = friction * hn::Max(zero - along, Pushed(l)) * per_length;
    const M less = hn::AndNot(is_given, slides);
    const bool apart = lanes_.bounded_apart;
    const V share = apart ? Set(1) : hn::IfThenElse(less, hn::Min(stopped, Set(1)), Set(1));
    Store(friction * share, &point->across, l);
  }

  /// What external impulses add to the speed of a body, the larger of both.
  HWY_INLINE V Pushed(int l) const {
    const Vector a = a_.free_velocity(l) - a_.start_velocity(l);
    const Vector b = b_.free_velocity(l) - b_.start_velocity(l);
    return hn::Sqrt(hn::Max(Dot(a, a), Dot(b, b)));
  }

  /// Start impulses along the directions of this frame, inside their bounds.
  HWY_INLINE void Start(int l, Point* point) {
    const V zero = hn::Zero(D()), most = Set(kMost);
    const Vector n = At(point->number + kNormal, l), axis = At(point->axis, l);
    const Heading last = FromHeading(Load(point->start[3], l));
    const V first = Load(point->start[1], l), second = Load(point->start[2], l);
    const V along = last.x * first + last.y * second, across = last.y * first - last.x * second;
    const V beside = hn::IfThenElse(last.known, across, second);
    const Vector push = along * axis + beside * Cross(n, axis);
    const V normal = Load(point->start[0], l), friction = Load(point->number[kFriction], l);
    // + 0: no target may leave a -0
    const V x = hn::Max(normal, zero) + zero;
    const V bound = friction * x, bound_across = Load(point->across, l) * x;
    const V x1 = Dot(push, At(point->t1, l)), x2 = Dot(push, At(point->t2, l));
    Store(x, point->x, l);
    Store(hn::Min(hn::Max(x1, zero - bound), bound) + zero, point->x + 1, l);
    Store(hn::Min(hn::Max(x2, zero - bound_across), bound_across) + zero, point->x + 2, l);

    // comparisons with what is not a number are false
    const auto in_range = [&](V value) HWY_ATTR { return hn::Le(hn::Abs(value), most); };
    const auto positive = [&](V value)
                              HWY_ATTR { return hn::And(hn::Ge(value, zero), in_range(value)); };
    M starts = hn::And(in_range(normal), hn::And(in_range(x1), in_range(x2)));
    // directions of what overflows, or of nothing, have none
    if (lanes_.tangents > 0) starts = hn::And(starts, in_range(Load(point->heading, l)));
    Demand(starts);
    Demand(hn::And(positive(friction), positive(Load(point->number[kRestitution], l))));
  }

  void ReadTwist(int p, const Point& point, Twist* twist) const {
    const float* numbers[kLanes];
    for (int l = 0; l < lanes_.lanes; ++l) {
      numbers[l] = lanes_.twist[l] + p * kTwistNumbers;
      const float* const start = lanes_.twist_start[l] + p * kTwistRows;
      for (int k = 0; k < kTwistRows; ++k) twist->start[k].lane[l] = start[k];
    }
    TransposeFour(numbers, lanes_.lanes, 0, twist->number);
    for (int l = 0; l < end_; l += kWidth) {
      const Vector n = At(point.number + kNormal, l), axis = At(point.axis, l);
      Put(n, twist->axis[0], l);
      Put(axis, twist->axis[1], l);
      Put(Cross(n, axis), twist->axis[2], l);
    }
  }

  /// Writes G of one axis to turn about; returns |G|^2.
  HWY_INLINE V PutTurning(Vector d, int l) {
    const V zero = hn::Zero(D());
    const Vector none{zero, zero, zero};
    Put(none, out_, l);
    if constexpr (form == PairForm::kSingle) {
      const Vector turn = moving_.Whiten(Load(sign_, l) * d, l);
      Put(turn, out_ + 3, l);
      return Dot(turn, turn);
    } else {
      const Vector turn_a = a_.Whiten(d, l), turn_b = b_.Whiten(Set(-1) * d, l);
      Put(turn_a, out_ + 3, l);
      if constexpr (form == PairForm::kJoint) Put(none, out_ + 6, l);
      Put(turn_b, out_ + JacobianLines(form) - 3, l);
      return Dot(turn_a, turn_a) + Dot(turn_b, turn_b);
    }
  }

  /// Writes G of one direction to push along; returns |G|^2.
  HWY_INLINE V PutPushing(const Point& point, Vector d, int l) {
    const Vector arm_a = At(point.number + kArmA, l), arm_b = At(point.number + kArmB, l);
    if constexpr (form == PairForm::kSingle) {
      const V sign = Load(sign_, l);
      const Vector arm = Where(hn::Gt(sign, hn::Zero(D())), arm_a, arm_b), along = sign * d;
      const Vector g = Scale(along, moving_.linear(l));
      const Vector turn = moving_.Whiten(Cross(arm, along), l);
      Put(g, out_, l);
      Put(turn, out_ + 3, l);
      return Dot(g, g) + Dot(turn, turn);
    } else {
      const Vector g_a = Scale(d, a_.linear(l)), g_b = Scale(Set(-1) * d, b_.linear(l));
      const Vector turn_a = a_.Whiten(Cross(arm_a, d), l), turn_b = b_.Whiten(Cross(d, arm_b), l);
      if constexpr (form == PairForm::kContact) {
        Put(Load(scale_, l) * d, out_, l);
      } else {
        Put(g_a, out_, l);
      }
      Put(turn_a, out_ + 3, l);
      if constexpr (form == PairForm::kJoint) Put(g_b, out_ + 6, l);
      Put(turn_b, out_ + JacobianLines(form) - 3, l);
      return (Dot(g_a, g_a) + Dot(turn_a, turn_a)) + (Dot(g_b, g_b) + Dot(turn_b, turn_b));
    }
  }

  /// G, target and step of one row; wanted(direction, l): its target.
  template <Acts acts = Acts::kPush, class Wanted>
  HWY_INLINE void PutRow(const Point& point, const Line* direction, const Line* compliance,
                         const Wanted& wanted) {
    Line* const behind = out_ + JacobianLines(form);
    for (int l = 0; l < end_; l += kWidth) {
      const Vector d = At(direction, l);
      V diagonal = acts == Acts::kPush ? PutPushing(point, d, l) : PutTurning(d, l);
      if (compliance != nullptr) diagonal = diagonal + Load(*compliance, l);
      Demand(PutStep(wanted(d, l), diagonal, l, behind));
    }
    out_ = behind + 2;
  }

  void PutNormal(const Point& point, Line* x) {
    const Line* const compliance = lanes_.soft ? &point.number[kCompliance] : nullptr;
    PutRow(point, point.number + kNormal, compliance,
           [&](Vector, int l) HWY_ATTR { return Load(point.wanted, l); });
    *x = point.x[0];
    if (compliance != nullptr) {
      for (int l = 0; l < end_; l += kWidth) {
        Demand(hn::Ge(Load(*compliance, l), hn::Zero(D())));
      }
      *out_++ = *compliance;
    }
    ++out_;  // the coupling
  }

  void PutFriction(const Point& point, const Line* direction, const Line& coefficient,
                   const Line& start, Line* x) {
    PutRow(point, direction, nullptr,
           [&](Vector d, int l) HWY_ATTR { return hn::Zero(D()) - Dot(d, At(point.slide, l)); });
    *out_++ = coefficient;
    ++out_;  // the coupling
    *x = start;
  }

  /// About axis @p k, with its start impulse inside its bounds.
  void PutTwist(const Point& point, const Twist& twist, int k, Line* x) {
    PutRow<Acts::kTurn>(point, twist.axis[k], nullptr, [&](Vector d, int l) HWY_ATTR {
      const bool before = lanes_.spin_before_torques;
      const Vector spin_a = before ? a_.start_spin(l) : a_.free_spin(l);
      const Vector spin_b = before ? b_.start_spin(l) : b_.free_spin(l);
      return hn::Zero(D()) - Dot(d, spin_a - spin_b);
    });
    const int kind = k == 0 ? 0 : 1;
    for (int l = 0; l < end_; l += kWidth) {
      const V zero = hn::Zero(D()), start = Load(twist.start[k], l);
      const V coefficient = Load(twist.number[kind], l);
      const V most = Load(twist.number[kMostSpinning + kind], l);
      const V bound = hn::Min(coefficient * Load(point.x[0], l), most);
      Store(coefficient, out_, l);
      Store(zero - most, out_ + 1, l);
      Store(most, out_ + 2, l);
      Store(hn::Min(hn::Max(start, zero - bound), bound) + zero, x, l);
      Demand(hn::And(hn::Le(hn::Abs(start), Set(kMost)), hn::Ge(most, zero)));
      Demand(hn::And(hn::Ge(coefficient, zero), hn::Le(coefficient, Set(kMost))));
    }
    out_ += BoundLines(RowBound::kCutFriction) + 1;  // and the coupling
  }

  const ContactLanes& lanes_;
  const int end_;  ///< Of the registers that hold them.
  Line* out_;
  Line* x_;
  Bodies a_, b_, moving_;  ///< moving_: of PairForm::kSingle
  Line sign_ = {};         ///< of the moving body in a row
  Line scale_;             ///< of PairForm::kContact, see PutPair()
  bool fits_ = true;
};

inline bool PackContacts(const ContactLanes& lanes, Line* out, Line* x, Line* directions) {
  switch (lanes.form) {
    case PairForm::kJoint:
      return Packer<PairForm::kJoint>(lanes, out, x).Pack(directions);
    case PairForm::kContact:
      return Packer<PairForm::kContact>(lanes, out, x).Pack(directions);
    case PairForm::kSingle:
      return Packer<PairForm::kSingle>(lanes, out, x).Pack(directions);
  }
  return false;
}

inline void UnpackContacts(const ContactResults& results) {
  const Line zero = {};
  const Line* friction = results.x + results.points;
  const Line* direction = results.directions;
  float* to[kLanes];
  std::copy_n(results.to, results.lanes, to);
  for (int p = 0; p < results.points; ++p, direction += kDirectionLines) {
    const Line* x[2] = {&zero, &zero};
    const Line* t1[kDirectionLines] = {&zero, &zero, &zero, &zero};
    for (int k = 0; k < results.tangents; ++k) x[k] = friction++;
    for (int k = 0; k < kDirectionLines && results.tangents > 0; ++k) t1[k] = direction + k;
    StoreFour({results.x + p, x[0], x[1], t1[3]}, results.lanes, to, 0);
    StoreFour({t1[3], t1[0], t1[1], t1[2]}, results.lanes, to, 3);
    for (int l = 0; l < results.lanes; ++l) to[l] += kStartStride;
  }
}

constexpr ContactKernels kContactKernels = {PackContacts, UnpackContacts};

}  // namespace contacts
}  // namespace HWY_NAMESPACE
}  // namespace cairn::simd
HWY_AFTER_NAMESPACE();

#endif
