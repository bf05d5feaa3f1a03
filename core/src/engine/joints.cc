// SPDX-License-Identifier: MIT
#include "cairn/joints.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "engine/angle.h"
#include "engine/room.h"
#include "engine/step_body.h"

namespace cairn {
namespace {

using Eigen::Vector3d;

constexpr JointAxis kHeld{.lo = 0, .hi = 0};
/// What is hit may move this fast within a step: axes with less room have rows for both limits.
constexpr double kFast = 30, kFastTurn = 60;  // [m/s], [rad/s]

/// Twist of a against b about their x axes, and the axis that it turns about while the angle
/// between these stays as it is.
struct Twist {
  double angle;
  Vector3d axis;
};

Vector3d Between(const Vector3& to, const Vector3& from) { return View(to) - View(from); }

Twist FindTwist(const JointSide& a, const JointSide& b) {
  const Eigen::Quaterniond turn(Eigen::Matrix3d(View(b.axes).transpose() * View(a.axes)));
  const Vector3d x_a = View(a.axes).col(0), x_b = View(b.axes).col(0);
  // (x_a + x_b) / (1 + x_a.x_b) has no bound where these are opposite
  const double both = 1 + x_a.dot(x_b);
  const Vector3d axis = both > 0.1 ? Vector3d((x_a + x_b) / both) : x_b;
  return {.angle = WrapAngle(2 * ArcTan2(turn.x(), turn.w())), .axis = axis};
}

/// An angle in (-pi, pi], or the same some turns away: the one within half a turn of the middle of
/// the limits, or of where the spring wants to be.
double Unwrap(const JointAxis& axis, double angle) {
  const double width = axis.hi - axis.lo;
  const double centre = width < 2 * kPi ? axis.lo + width / 2 : axis.rest;
  const double off = angle - centre;
  return std::abs(off) <= kPi ? angle : centre + std::remainder(off, 2 * kPi);
}

}  // namespace

/// The rows of one axis, as vectors of body a; those of b are opposite but for the arm.
struct Joints::Direction {
  HalfRow a, b;
  bool turns;
};

JointKind BallJoint() { return {.linear = {kHeld, kHeld, kHeld}, .twist = {}}; }

JointKind HingeJoint(const JointAxis& about_x) {
  return {.linear = {kHeld, kHeld, kHeld}, .twist = about_x, .cone = 0};
}

JointKind SliderJoint(const JointAxis& along_x) {
  return {.linear = {along_x, kHeld, kHeld}, .twist = kHeld, .cone = 0};
}

JointKind FixedJoint() { return HingeJoint(kHeld); }

JointKind ConeTwistJoint(double cone, const JointAxis& twist) {
  return {.linear = {kHeld, kHeld, kHeld}, .twist = twist, .cone = cone};
}

double TwistOf(const JointSide& a, const JointSide& b) { return FindTwist(a, b).angle; }

Joints::Joints(double erp, Memory* memory)
    : erp_(erp), joints_(memory), rows_(memory), impulses_(memory), memory_(memory) {}

void Joints::Begin(const StepInput& step) {
  memory_.Begin(impulses_, step.bodies, step.time_step);
  step_ = step;
  gap_ = angle_ = {};
  refused_ = {};
  joints_.clear();
  rows_.clear();
  impulses_.clear();
}

bool Joints::Refuse(const detail::BadValue& bad) {
  refused_ = detail::FindBadErp(erp_, "erp");
  if (!refused_) refused_ = bad;
  return static_cast<bool>(refused_);
}

int Joints::Add(const JointKind& kind, const JointSide& a, const JointSide& b, std::uint64_t id) {
  if (Refuse(detail::FindBad(kind, a, b, static_cast<int>(step_.bodies.size())))) return -1;
  Open(a, b);
  const Vector3d apart = Between(a.anchor, b.anchor);
  for (int i = 0; i < 3; ++i) {
    // both arms end in the anchor of a: the axis turns with b
    const Vector3d axis = View(b.axes).col(i);
    const Direction direction{.a = {axis, Between(a.anchor, a.centre).cross(axis)},
                              .b = {-axis, -Between(a.anchor, b.centre).cross(axis)},
                              .turns = false};
    AddAxis(kind.linear[i], direction, axis.dot(apart));
  }
  AddCone(kind.cone, a, b);
  const Twist twist = FindTwist(a, b);
  AddAxis(
      kind.twist,
      {.a = {Vector3d::Zero(), twist.axis}, .b = {Vector3d::Zero(), -twist.axis}, .turns = true},
      Unwrap(kind.twist, twist.angle));
  return Close(id);
}

int Joints::AddDistance(const JointAxis& length, const JointSide& a, const JointSide& b,
                        std::uint64_t id) {
  if (Refuse(detail::FindBad(length, a, b, static_cast<int>(step_.bodies.size())))) return -1;
  Open(a, b);
  const Vector3d apart = Between(a.anchor, b.anchor);
  const double distance = apart.norm();
  const Vector3d axis = distance > 1e-9 ? Vector3d(apart / distance) : Vector3d::UnitX();
  AddAxis(length,
          {.a = {axis, Between(a.anchor, a.centre).cross(axis)},
           .b = {-axis, -Between(b.anchor, b.centre).cross(axis)},
           .turns = false},
          distance);
  return Close(id);
}

int Joints::AddGear(const JointGear& a, const JointGear& b, std::uint64_t id) {
  if (Refuse(detail::FindBad(a, b, static_cast<int>(step_.bodies.size())))) return -1;
  Open(a.side, b.side);
  // as a turns: by what teeth of b that pass turn it
  const double ratio = static_cast<double>(b.teeth) / a.teeth;
  const double meshed = a.teeth * a.angle + b.teeth * b.angle;
  // exact with every library; half a tooth off it falls into the next gap
  const double error = std::remainder(meshed, 2 * kPi) / a.teeth;
  JointRow& row = AddRow({.a = {Vector3d::Zero(), View(a.side.axes).col(0)},
                          .b = {Vector3d::Zero(), ratio * View(b.side.axes).col(0)},
                          .turns = true});
  TakeBack(error, &row);
  return Close(id);
}

void Joints::Open(const JointSide& a, const JointSide& b) {
  MakeRoom(1, &joints_);
  memory_.Reserve(1);
  MakeRoom(Joint::kMostRows, &rows_);
  MakeRoom(Joint::kMostRows, &impulses_);
  Joint& joint = joints_.emplace_back();
  joint.body_a = a.body;
  joint.body_b = b.body;
  joint.first_row = static_cast<int>(rows_.size());
  joint.rows = 0;
  joint.opposite = true;
  gap_square_ = angle_square_ = 0;
}

JointRow& Joints::AddRow(const Direction& direction) {
  Joint& joint = joints_.back();
  if (direction.turns) joint.angular |= std::uint32_t{1} << joint.rows;
  ++joint.rows;
  JointRow& row = rows_.emplace_back();
  const auto put = [](int body, const HalfRow& from, float* linear, float* angular) {
    PutFloats(from.linear, linear);
    PutFloats(body == kWorld ? Vector3d(Vector3d::Zero()) : from.angular, angular);
  };
  put(joint.body_a, direction.a, row.linear_a, row.angular_a);
  put(joint.body_b, direction.b, row.linear_b, row.angular_b);
  return row;
}

void Joints::TakeBack(double error, JointRow* row) {
  Joint& joint = joints_.back();
  const std::uint32_t bit = std::uint32_t{1} << (joint.rows - 1);
  joint.errors |= bit;
  ((joint.angular & bit) != 0 ? angle_square_ : gap_square_) += error * error;
  row->target = static_cast<float>(PerSecond(-erp_ * error, step_.time_step));
}

void Joints::AddAxis(const JointAxis& axis, const Direction& direction, double position) {
  const double h = step_.time_step;
  const auto bound = [this](double lo, double hi, JointRow* row) {
    Joint& joint = joints_.back();
    joint.bounded |= std::uint32_t{1} << (joint.rows - 1);
    row->lo = static_cast<float>(lo);
    row->hi = static_cast<float>(hi);
  };
  // a motor that is strong enough would fight the limits, and win
  double least = -kInfinity, most = kInfinity;
  if (axis.lo == axis.hi) {
    JointRow& row = AddRow(direction);
    TakeBack(position - axis.lo, &row);
    least = most = row.target;
  } else if (axis.lo > -kInfinity || axis.hi < kInfinity) {
    const auto limit = [&](bool lower) {
      const double to_limit = (lower ? axis.lo : axis.hi) - position;
      const bool inside = lower ? to_limit <= 0 : to_limit >= 0;
      JointRow& row = AddRow(direction);
      if (inside) {
        row.target = static_cast<float>(SpeedToPass(to_limit, h));
      } else {
        TakeBack(-to_limit, &row);
      }
      lower ? bound(0, kInfinity, &row) : bound(-kInfinity, 0, &row);
      return static_cast<double>(row.target);
    };
    least = SpeedToPass(axis.lo - position, h);
    most = SpeedToPass(axis.hi - position, h);
    const bool narrow = axis.hi - axis.lo < h * (direction.turns ? kFastTurn : kFast);
    const bool lower = position - axis.lo <= axis.hi - position;
    if (narrow || lower) least = limit(true);
    if (narrow || !lower) most = limit(false);
  }
  if (axis.max_motor_force > 0) {
    JointRow& row = AddRow(direction);
    row.target = static_cast<float>(std::min(std::max(axis.speed, least), most));
    bound(-h * axis.max_motor_force, h * axis.max_motor_force, &row);
  }
  if (axis.frequency > 0) {
    const Joint& joint = joints_.back();
    const double mobility =
        Mobility(step_, joint.body_a, direction.a) + Mobility(step_, joint.body_b, direction.b);
    const SoftRow soft = Soften(axis.frequency, axis.damping_ratio, mobility, h);
    JointRow& row = AddRow(direction);
    row.target = static_cast<float>(PerSecond(-soft.share * (position - axis.rest), h));
    row.compliance = static_cast<float>(soft.compliance);
    joints_.back().soft = true;
    const double most_impulse = h > 0 ? h * axis.max_spring_force : 0;
    if (most_impulse < kInfinity) bound(-most_impulse, most_impulse, &row);
  }
}

void Joints::AddCone(double cone, const JointSide& a, const JointSide& b) {
  const Vector3d x_a = View(a.axes).col(0), x_b = View(b.axes).col(0), across = x_b.cross(x_a);
  const double sine = across.norm(), cosine = x_b.dot(x_a);
  const double angle = ArcTan2(sine, cosine);
  const Vector3d axis = sine > 1e-9 ? Vector3d(across / sine) : Vector3d(View(b.axes).col(1));
  const auto about = [](const Vector3d& u) {
    return Direction{.a = {Vector3d::Zero(), u}, .b = {Vector3d::Zero(), -u}, .turns = true};
  };
  if (cone > 0) {
    if (cone < kPi) AddAxis({.hi = cone}, about(axis), angle);
    return;
  }
  for (int i = 1; i < 3; ++i) {
    const Vector3d u = View(b.axes).col(i);
    AddAxis(kHeld, about(u), angle * axis.dot(u));
  }
}

int Joints::Close(std::uint64_t id) {
  const Joint& joint = joints_.back();
  if (joint.rows == 0) {
    joints_.pop_back();
    return -1;
  }
  const auto tell = [this](double square, PositionError* worst) {
    const double error = std::sqrt(square);
    if (error > worst->largest) *worst = {error, erp_ * error};
  };
  tell(gap_square_, &gap_);
  tell(angle_square_, &angle_);
  impulses_.resize(rows_.size(), 0);
  const auto start = memory_.Add({id, 0}, joint.body_a, joint.body_b, joint.rows);
  for (int i = 0; i < joint.rows && start.impulses != nullptr; ++i) {
    impulses_[joint.first_row + i] = start.share * start.impulses[i];
  }
  return static_cast<int>(joints_.size()) - 1;
}

ContactProblem ProblemOf(const StepInput& step, const Contacts& contacts, const Joints& joints) {
  return {.bodies = step.bodies,
          .manifolds = contacts.manifolds(),
          .points = contacts.points(),
          .joints = joints.joints(),
          .joint_rows = joints.rows(),
          .time_step = step.time_step};
}

Impulses StartOf(Contacts* contacts, Joints* joints) {
  return {.points = contacts->impulses(), .joint_rows = joints->impulses()};
}

}  // namespace cairn
