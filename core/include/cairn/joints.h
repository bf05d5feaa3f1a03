// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <cstdint>
#include <span>
#include <string>

#include "cairn/contacts.h"

namespace cairn {

/// One direction in which two bodies may move against each other: along an axis [m, m/s, N] or
/// about it [rad, rad/s, N m]. As it comes: free. Positive is body a along the axis, or turning
/// about it by the right hand, as seen from body b.
struct JointAxis {
  double lo = -kInfinity, hi = kInfinity;  ///< Limits, lo <= hi; equal: held there.
  double speed = 0;                        ///< That the motor wants.
  double max_motor_force = 0;              ///< Its largest force, >= 0; 0: no motor.
  double rest = 0;                         ///< Where the spring wants to be: a target.
  double frequency = 0;                    ///< Of the spring [Hz], >= 0; 0: no spring.
  double damping_ratio = 1;                ///< Of the spring, >= 0. 1 is critical.
  double max_spring_force = kInfinity;     ///< Its largest force, > 0.
};

/// All ways: the point of a along the axes of b, the twist about their x axes, and the angle
/// between these, at most cone [rad]; 0: they stay parallel, pi and more: free. A twist is known
/// but for whole turns: the one within pi of the middle of its limits counts, or of the spring's
/// rest.
struct JointKind {
  JointAxis linear[3];
  JointAxis twist;
  double cone = kInfinity;
};

JointKind BallJoint();
JointKind HingeJoint(const JointAxis& about_x = {});
JointKind SliderJoint(const JointAxis& along_x = {});
JointKind FixedJoint();
JointKind ConeTwistJoint(double cone, const JointAxis& twist);

/// What a joint holds of one body, at the start of the step, in the world.
struct JointSide {
  int body = kWorld;
  Vector3 centre = {};  ///< Of mass [m]; not looked at for kWorld.
  Vector3 anchor = {};  ///< A point of the body [m].
  /// Columns: three unit vectors at right angles, right-handed, that turn with the body. Those of
  /// both sides agree where all angles are 0.
  Matrix3 axes = Matrix3::Diagonal(1, 1, 1);
};

/// By which body a is twisted, as JointKind::twist counts it [rad], in (-pi, pi].
double TwistOf(const JointSide& a, const JointSide& b);

/// A wheel with teeth, about the x axis of its side.
struct JointGear {
  JointSide side;    ///< Its anchor is not looked at.
  double angle = 0;  ///< That it has turned by, whole turns aside: TwistOf() of its hinge [rad].
  int teeth = 1;     ///< Not 0. Below 0 it turns the other way: a ring, a belt.
};

/// Makes joints, and starts their rows from what they exerted in the last frame, or, as Contacts,
/// before they fell asleep. In each frame: Begin(), Add() for each joint, Solve() with joints(),
/// rows() and impulses(). A frame with no more joints than an earlier one allocates nothing.
///
/// Rows of an axis, in this order, so that the same kind always has the same rows (C: position, h:
/// time step; w = dC/dt):
///   held:    w = -erp (C - lo) / h;
///   limit:   the nearer one, or both, hi last, where 30 m/s or 60 rad/s would pass them in a step:
///            w >= (lo - C) / h where there is room, erp (lo - C) / h where not;
///   motor:   w = speed, or what limits leave of it, by an impulse within +-h max_motor_force;
///   spring:  an implicit step of it, within +-h max_spring_force: as soft contacts in contacts.h.
class Joints {
 public:
  Joints() = default;
  /// @param erp  share of an error that is taken back in a step, in [0, 1]
  explicit Joints(double erp, Memory* memory = nullptr);

  /// Begins a frame. The bodies are looked at until the last Add(). Where memory ends, this and
  /// Add() throw std::bad_alloc, and have changed nothing.
  void Begin(const StepInput& step);
  /// @param id  names the joint while it lives; 0: no name, no warm start
  /// @return    its place in joints(); -1, and nothing is added, if the kind holds nothing, or a
  ///            value is out of its range, which complaint() names
  int Add(const JointKind& kind, const JointSide& a, const JointSide& b, std::uint64_t id);
  /// An axis along the line between the anchors: a rod where it is held, a rope with a limit hi, a
  /// spring. Axes of the sides are not looked at.
  int AddDistance(const JointAxis& length, const JointSide& a, const JointSide& b,
                  std::uint64_t id);

  /// Teeth of two wheels that turn about the x axes of their sides, on hinges of their own: as many
  /// of one pass as of the other, against each other where the axes agree.
  int AddGear(const JointGear& a, const JointGear& b, std::uint64_t id);
  /// Why the last was refused: "kind.twist.lo is 2, must be at most hi". Empty if it was not.
  std::string complaint() const { return Describe(refused_); }
  const detail::BadValue& refused() const { return refused_; }

  std::span<const Joint> joints() const { return joints_; }
  std::span<const JointRow> rows() const { return rows_; }
  std::span<float> impulses() { return impulses_; }
  /// Of the joints added since Begin(): how far anchors are apart, or beyond a limit [m], and how
  /// far axes are turned away [rad].
  PositionError worst_gap() const { return gap_; }
  PositionError worst_angle() const { return angle_; }
  /// What the rows of a joint exerted [N s] or [N m s], after Solve().
  std::span<const float> impulses_of(int joint) const {
    const Joint& of = joints_[static_cast<std::size_t>(joint)];
    return std::span(impulses_).subspan(static_cast<std::size_t>(of.first_row),
                                        static_cast<std::size_t>(of.rows));
  }

 private:
  struct Direction;

  bool Refuse(const detail::BadValue& bad);
  void Open(const JointSide& a, const JointSide& b);
  void AddAxis(const JointAxis& axis, const Direction& direction, double position);
  void AddCone(double cone, const JointSide& a, const JointSide& b);
  JointRow& AddRow(const Direction& direction);
  /// A share of it in a step, by the last row.
  void TakeBack(double error, JointRow* row);
  int Close(std::uint64_t id);

  double erp_ = 0.2;
  StepInput step_;
  PositionError gap_, angle_;
  detail::BadValue refused_;
  double gap_square_ = 0, angle_square_ = 0;  ///< of the joint that is added
  Array<Joint> joints_;
  Array<JointRow> rows_;
  Array<float> impulses_;
  detail::StartMemory memory_;
};

/// The frame that these make, and where it starts. Both point into them: no Begin() or Add()
/// between this and Solve().
ContactProblem ProblemOf(const StepInput& step, const Contacts& contacts, const Joints& joints);
Impulses StartOf(Contacts* contacts, Joints* joints);

}  // namespace cairn
