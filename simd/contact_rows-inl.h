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

#include "simd/contact_rows.h"

HWY_BEFORE_NAMESPACE();
namespace cairn::simd {
namespace HWY_NAMESPACE {
namespace contacts {
namespace hn = hwy::HWY_NAMESPACE;

/// What a float can hold with its square.
constexpr float kMost = 1e18f, kLeast = 1e-18f;
/// Points that slide slower have no direction [m^2/s^2].
constexpr float kLeastSlide = 1.1920929e-7f;
constexpr float kRootHalf = 0.70710678f;

/// Four numbers of every lane from @p number on.
HWY_INLINE void TransposeFour(const float* const* from, int number, Line* to) {
#if HWY_TARGET == HWY_SCALAR
  for (int l = 0; l < kLanes; ++l) {
    for (int k = 0; k < 4; ++k) to[k].lane[l] = from[l][number + k];
  }
#else
  const hn::FixedTag<float, 4> d;
  for (int l = 0; l < kLanes; l += 4) {
    const auto r0 = hn::LoadU(d, from[l] + number), r1 = hn::LoadU(d, from[l + 1] + number);
    const auto r2 = hn::LoadU(d, from[l + 2] + number), r3 = hn::LoadU(d, from[l + 3] + number);
    const auto xy02 = hn::InterleaveLower(d, r0, r2), xy13 = hn::InterleaveLower(d, r1, r3);
    const auto zw02 = hn::InterleaveUpper(d, r0, r2), zw13 = hn::InterleaveUpper(d, r1, r3);
    hn::Store(hn::InterleaveLower(d, xy02, xy13), d, to[0].lane + l);
    hn::Store(hn::InterleaveUpper(d, xy02, xy13), d, to[1].lane + l);
    hn::Store(hn::InterleaveLower(d, zw02, zw13), d, to[2].lane + l);
    hn::Store(hn::InterleaveUpper(d, zw02, zw13), d, to[3].lane + l);
  }
#endif
}

using D = hn::CappedTag<float, kLanes>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
constexpr int kWidth = static_cast<int>(hn::MaxLanes(D()));

HWY_INLINE V Set(float value) { return hn::Set(D(), value); }
HWY_INLINE V Load(const Line& line, int l) { return hn::Load(D(), line.lane + l); }
HWY_INLINE void Store(V v, Line* line, int l) { hn::Store(v, D(), line->lane + l); }

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

HWY_INLINE void Gather(const ContactBody* const* from, Bodies* bodies) {
  const float* numbers[kLanes];
  for (int l = 0; l < kLanes; ++l) numbers[l] = from[l]->linear;
  for (int k = 0; k < kContactBodyNumbers; k += 4) TransposeFour(numbers, k, bodies->number + k);
}

/// One point of all lanes: what was read, and what its rows have in common.
struct Point {
  Line number[kPointNumbers];
  Line start[kStartNumbers];
  Line axis[3];  ///< the first of the plane across the normal
  Line t1[3], t2[3];
  Line heading;   ///< of t1
  Line slide[3];  ///< relative velocity that friction works against
  Line wanted;    ///< along the normal, relative to the velocity without constraints
  Line x[3];      ///< start impulses
};

template <PairForm form>
class Packer {
 public:
  Packer(const ContactLanes& lanes, Line* out, Line* x) : lanes_(lanes), out_(out), x_(x) {
    Gather(lanes.a, &a_);
    Gather(lanes.b, &b_);
    if constexpr (form == PairForm::kSingle) {
      const ContactBody* moving[kLanes];
      for (int l = 0; l < kLanes; ++l) {
        moving[l] = lanes.second_moves[l] ? lanes.b[l] : lanes.a[l];
        sign_.lane[l] = lanes.second_moves[l] ? -1.0f : 1.0f;
      }
      Gather(moving, &moving_);
    }
  }

  bool Pack(Line* directions) {
    if constexpr (form == PairForm::kContact) {
      *out_++ = a_.number[0];
      *out_++ = b_.number[0];
    }
    Point points[kMostPoints];
    for (int p = 0; p < lanes_.points; ++p) {
      Read(p, &points[p]);
      for (int l = 0; l < kLanes; l += kWidth) {
        Aim(l, &points[p]);
        Start(l, &points[p]);
      }
      PutNormal(points[p], x_ + p);
    }
    for (int p = 0; p < lanes_.points && lanes_.tangents > 0; ++p) {
      Line* const x = x_ + lanes_.points + p * lanes_.tangents;
      PutFriction(points[p], points[p].t1, points[p].x[1], x);
      if (lanes_.tangents > 1) PutFriction(points[p], points[p].t2, points[p].x[2], x + 1);
      for (int k = 0; k < 3; ++k) directions[kDirectionLines * p + k] = points[p].t1[k];
      directions[kDirectionLines * p + 3] = points[p].heading;
    }
    return fits_;
  }

 private:
  void Read(int p, Point* point) const {
    const float *numbers[kLanes], *starts[kLanes];
    for (int l = 0; l < kLanes; ++l) {
      numbers[l] = lanes_.point[l] + p * kPointNumbers;
      starts[l] = lanes_.start[l] + p * kStartStride;
    }
    for (int k = 0; k < kPointNumbers; k += 4) TransposeFour(numbers, k, point->number + k);
    TransposeFour(starts, 0, point->start);
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
    const V x = hn::Max(normal, zero) + zero, bound = friction * x;
    const V x1 = Dot(push, At(point->t1, l)), x2 = Dot(push, At(point->t2, l));
    Store(x, point->x, l);
    Store(hn::Min(hn::Max(x1, zero - bound), bound) + zero, point->x + 1, l);
    Store(hn::Min(hn::Max(x2, zero - bound), bound) + zero, point->x + 2, l);

    // comparisons with what is not a number are false
    const auto in_range = [&](V value) HWY_ATTR { return hn::Le(hn::Abs(value), most); };
    const auto positive = [&](V value)
                              HWY_ATTR { return hn::And(hn::Ge(value, zero), in_range(value)); };
    Demand(hn::And(in_range(normal), hn::And(in_range(x1), in_range(x2))));
    Demand(hn::And(positive(friction), positive(Load(point->number[kRestitution], l))));
  }

  /// Writes G of one direction; returns |G|^2.
  HWY_INLINE V PutJacobian(const Point& point, Vector d, int l) {
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
      Put(form == PairForm::kContact ? d : g_a, out_, l);
      Put(turn_a, out_ + 3, l);
      if constexpr (form == PairForm::kJoint) Put(g_b, out_ + 6, l);
      Put(turn_b, out_ + JacobianLines(form) - 3, l);
      return (Dot(g_a, g_a) + Dot(turn_a, turn_a)) + (Dot(g_b, g_b) + Dot(turn_b, turn_b));
    }
  }

  /// G, target and step of one row; wanted(direction, l): its target.
  template <class Wanted>
  HWY_INLINE void PutRow(const Point& point, const Line* direction, const Line* compliance,
                         const Wanted& wanted) {
    const V zero = hn::Zero(D()), one = Set(1), most = Set(kMost);
    Line* const behind = out_ + JacobianLines(form);
    for (int l = 0; l < kLanes; l += kWidth) {
      const Vector d = At(direction, l);
      V diagonal = PutJacobian(point, d, l);
      if (compliance != nullptr) diagonal = diagonal + Load(*compliance, l);
      const M satisfiable = hn::Gt(diagonal, zero);
      const V target = wanted(d, l);
      Store(hn::IfThenElseZero(satisfiable, target), behind, l);
      Store(one / hn::IfThenElse(satisfiable, diagonal, one), behind + 1, l);
      Demand(hn::And(hn::And(hn::Le(hn::Abs(target), most), hn::Le(diagonal, most)),
                     hn::Or(hn::Ge(diagonal, Set(kLeast)), hn::Eq(diagonal, zero))));
    }
    out_ = behind + 2;
  }

  void PutNormal(const Point& point, Line* x) {
    const Line* const compliance = lanes_.soft ? &point.number[kCompliance] : nullptr;
    PutRow(point, point.number + kNormal, compliance,
           [&](Vector, int l) HWY_ATTR { return Load(point.wanted, l); });
    *x = point.x[0];
    if (compliance == nullptr) return;
    for (int l = 0; l < kLanes; l += kWidth) {
      Demand(hn::Ge(Load(*compliance, l), hn::Zero(D())));
    }
    *out_++ = *compliance;
  }

  void PutFriction(const Point& point, const Line* direction, const Line& start, Line* x) {
    PutRow(point, direction, nullptr,
           [&](Vector d, int l) HWY_ATTR { return hn::Zero(D()) - Dot(d, At(point.slide, l)); });
    *out_++ = point.number[kFriction];
    *x = start;
  }

  const ContactLanes& lanes_;
  Line* out_;
  Line* x_;
  Bodies a_, b_, moving_;  ///< moving_: of PairForm::kSingle
  Line sign_;              ///< of the moving body in a row
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

}  // namespace contacts
}  // namespace HWY_NAMESPACE
}  // namespace cairn::simd
HWY_AFTER_NAMESPACE();

#endif
