// SPDX-License-Identifier: MIT
#include "cycle/substeps.h"

#include <algorithm>
#include <cmath>

#include "cairn/detail/eigen.h"
#include "cycle/joint_arms.h"

namespace cairn {
namespace {

using Eigen::Vector3d;

/// Of what rows are behind, what the next part takes back. More is exact on chains, and throws
/// bodies where sweeps leave much: half of it 2 of 240 random worlds.
constexpr double kGain = 0.2;
/// Targets that floats hold.
constexpr double kMostTarget = 1e30;
/// Half an angle whose sine is found at once [rad]; a larger turn is that of half of it, twice.
constexpr double kMostHalfTurn = 1;
/// What is faster turns by nobody knows what.
constexpr int kMostDoublings = 40;

/// What compliance yielded, where it is read.
double Yielded(double compliance, double impulse) { return compliance * impulse; }

Vector3d ToVector(const float* from) { return {from[0], from[1], from[2]}; }
Vector3d ToVector(const Vector3d& from) { return from; }

float ToFloat(double value) {
  return static_cast<float>(std::clamp(value, -kMostTarget, kMostTarget));
}

void Put(const Vector3d& from, float* to) {
  for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(from[k]);
}

void AddTo(const Velocity& change, double factor, Velocity* to) {
  View(to->linear) += factor * View(change.linear);
  View(to->angular) += factor * View(change.angular);
}

double Dot(const Vector3d& linear, const Vector3d& angular, const Velocity& velocity) {
  return linear.dot(View(velocity.linear)) + angular.dot(View(velocity.angular));
}

/// Along the normal of a point, of body a relative to b.
double Apart(const ContactPoint& point, const Velocity& a, const Velocity& b) {
  const Vector3d n = ToVector(point.normal);
  return n.dot(View(a.linear) + View(a.angular).cross(ToVector(point.arm_a)) -
               (View(b.linear) + View(b.angular).cross(ToVector(point.arm_b))));
}

bool IsBoundedBelow(double lo) { return lo > -kInfinity; }
bool IsBoundedAbove(double hi) { return hi < kInfinity; }

}  // namespace

void Substeps::Begin(const ContactProblem& problem, const Impulses& start, int parts) {
  whole_ = problem;
  parts_ = parts;
  part_ = 0;
  bodies_.assign(problem.bodies.begin(), problem.bodies.end());
  rows_.assign(problem.rows.begin(), problem.rows.end());
  points_.assign(problem.points.begin(), problem.points.end());
  motions_.assign(problem.motions.begin(), problem.motions.end());
  twists_.assign(problem.twists.begin(), problem.twists.end());
  joint_rows_.assign(problem.joint_rows.begin(), problem.joint_rows.end());
  travels_.resize(bodies_.size());
  means_.assign(bodies_.size(), {});
  velocities_.assign(bodies_.size(), {});
  relaxed_ = false;
  for (size_t i = 0; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    Travel& travel = travels_[i];
    travel = {};
    travel.start = travel.now = body.velocity;
    travel.pushed.linear =
        body.inv_mass * View(body.linear_factor).cwiseProduct(View(body.impulse));
    travel.pushed.angular = View(body.inv_inertia) * View(body.angular_impulse);
    if (!motions_.empty()) {
      const ContactMotion& motion = motions_[i];
      travel.start = {ToVector(motion.start_velocity), ToVector(motion.start_spin)};
      travel.pushed = {ToVector(motion.free_velocity), ToVector(motion.free_spin)};
      AddTo(travel.start, -1, &travel.pushed);
      AddTo(travel.start, 1, &travel.now);
    }
    View(body.impulse) *= share();
    View(body.angular_impulse) *= share();
  }
  for (ContactTwist& twist : twists_) {
    twist.most_spinning *= static_cast<float>(share());
    twist.most_rolling *= static_cast<float>(share());
  }
  MoveMotions();
  Start(start);
  FindHeld();
  AimRows();
  AimJoints();
  AimPoints();
}

void Substeps::Start(const Impulses& start) {
  rows_x_.assign(start.rows.begin(), start.rows.end());
  points_x_.assign(start.points.begin(), start.points.end());
  twists_x_.assign(start.twists.begin(), start.twists.end());
  joints_x_.assign(start.joint_rows.begin(), start.joint_rows.end());
  const auto part = static_cast<float>(share());
  for (double& x : rows_x_) x *= share();
  for (float& x : joints_x_) x *= part;
  for (ContactImpulse& x : points_x_) {
    x.normal *= part;
    for (float& t : x.tangential) t *= part;
  }
  for (TwistImpulse& x : twists_x_) {
    x.spinning *= part;
    for (float& r : x.rolling) r *= part;
  }
  rows_sum_.assign(rows_x_.size(), 0);
  points_sum_.assign(points_x_.size(), {});
  twists_sum_.assign(twists_x_.size(), {});
  joints_sum_.assign(joints_x_.size(), 0);
}

void Substeps::FindHeld() {
  held_.clear();
  is_held_.assign(joint_rows_.size(), 0);
  if (!(whole_.time_step > 0)) return;
  for (int j = 0; j < static_cast<int>(whole_.joints.size()); ++j) {
    const Joint& joint = whole_.joints[j];
    for (int row = 0; row + 3 <= joint.rows;) {
      const JointRow* const of_joint = &joint_rows_[joint.first_row];
      // what has bounds is a motor or a limit, and holds no point
      if (!HoldPoint(joint, of_joint, row)) {
        ++row;
        continue;
      }
      const RowTriple rows = ReadTriple(joint, of_joint, row);
      held_.push_back(
          {j, row, ArmOf(rows.linear_a, rows.angular_a), ArmOf(rows.linear_b, rows.angular_b)});
      for (int k = 0; k < 3; ++k) is_held_[joint.first_row + row + k] = 1;
      row += 3;
    }
  }
}

ContactProblem Substeps::problem() const {
  return {.bodies = bodies_,
          .rows = rows_,
          .manifolds = whole_.manifolds,
          .points = points_,
          .contact_law = whole_.contact_law,
          .motions = motions_,
          .twists = twists_,
          .joints = whole_.joints,
          .joint_rows = joint_rows_,
          .time_step = whole_.time_step * share()};
}

bool Substeps::HasErrors(double least) const {
  for (const Joint& joint : whole_.joints) {
    for (int i = 0; i < joint.rows && joint.errors != 0; ++i) {
      const double target = joint_rows_[joint.first_row + i].target;
      if ((joint.errors >> i & 1) != 0 && std::abs(target) > least) return true;
    }
  }
  for (const Manifold& manifold : whole_.manifolds) {
    for (int p = 0; p < manifold.points; ++p) {
      if (IsDepth(manifold, p) && points_[manifold.first_point + p].bias > least) return true;
    }
  }
  return false;
}

bool Substeps::IsDepth(const Manifold& manifold, int point) const {
  return (manifold.speeds >> point & 1) == 0 && points_[manifold.first_point + point].bias > 0;
}

void Substeps::Relax() {
  relaxed_ = true;
  moves_ = velocities_;
  for (const Joint& joint : whole_.joints) {
    for (int i = 0; i < joint.rows; ++i) {
      if ((joint.errors >> i & 1) != 0) joint_rows_[joint.first_row + i].target = 0;
    }
  }
  for (const Manifold& manifold : whole_.manifolds) {
    for (int p = 0; p < manifold.points; ++p) {
      if (IsDepth(manifold, p)) points_[manifold.first_point + p].bias = 0;
    }
  }
}

void Substeps::Advance() {
  Add();
  ++part_;
  MoveBodies();
  if (done()) return;
  AimRows();
  AimJoints();
  AimPoints();
}

void Substeps::Turn(const Vector3d& spin, Travel* travel) const {
  Vector3d half = 0.5 * share() * whole_.time_step * spin;
  int doublings = 0;
  for (; half.squaredNorm() > kMostHalfTurn * kMostHalfTurn && doublings < kMostDoublings;
       ++doublings) {
    half *= 0.5;
  }
  const double a2 = half.squaredNorm();
  if (!(a2 > 0 && a2 <= kMostHalfTurn * kMostHalfTurn)) return;
  // sine over angle, and cosine: no library is to decide their last bits
  const double sine = 1 - a2 / 6 * (1 - a2 / 20 * (1 - a2 / 42 * (1 - a2 / 72 * (1 - a2 / 110))));
  const double cosine = 1 - a2 / 2 * (1 - a2 / 12 * (1 - a2 / 30 * (1 - a2 / 56 * (1 - a2 / 90))));
  const Vector3d v = sine * half;
  Eigen::Quaterniond turn(cosine, v.x(), v.y(), v.z());
  for (int i = 0; i < doublings; ++i) turn = (turn * turn).normalized();
  travel->turn = turn * travel->turn;
  travel->turn.normalize();
  travel->turned = travel->turn.toRotationMatrix();
}

Vector3d Substeps::MeanSpin(const Travel& travel) const {
  const Eigen::Quaterniond& turn = travel.turn;
  const Vector3d v = turn.w() < 0 ? Vector3d(-turn.vec()) : Vector3d(turn.vec());
  const double length = v.norm(), w = std::abs(turn.w());
  if (!(length > 0)) return Vector3d::Zero();
  // half of half of half the angle, by its tangent: no library is to decide its last bits
  double t = length / (1 + w);
  double angles = 2;
  for (int i = 0; i < 2; ++i) {
    t /= 1 + std::sqrt(1 + t * t);
    angles *= 2;
  }
  const double t2 = t * t;
  const double angle =
      t * (1 - t2 * (1.0 / 3 - t2 * (1.0 / 5 - t2 * (1.0 / 7 - t2 * (1.0 / 9 - t2 / 11)))));
  Vector3d mean = v * (2 * angles * angle / (length * whole_.time_step));
  if (motions_.empty()) return mean;
  // relative to what motions say, like velocities
  const double pushed = (part_ + 1) * share() / 2;
  return mean - View(travel.start.angular) - pushed * View(travel.pushed.angular);
}

void Substeps::MoveBodies() {
  // one part turns bodies as its spin says, however fast
  const bool turns = whole_.time_step > 0 && parts_ > 1;
  const Array<Velocity>& moves = relaxed_ ? moves_ : velocities_;
  for (size_t i = 0; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    Travel& travel = travels_[i];
    body.velocity = velocities_[i];
    travel.now = velocities_[i];
    Velocity moved = moves[i];
    if (!motions_.empty()) {
      for (Velocity* velocity : {&travel.now, &moved}) {
        AddTo(travel.start, 1, velocity);
        AddTo(travel.pushed, share() * part_, velocity);
      }
    }
    AddTo(moved, share(), &travel.total);
    AddTo(moves[i], share(), &means_[i]);
    if (!turns) continue;
    Turn(moved.angular, &travel);
    if (done()) means_[i].angular = MeanSpin(travel);
  }
  MoveMotions();
  relaxed_ = false;
}

void Substeps::MoveMotions() {
  for (size_t i = 0; i < motions_.size(); ++i) {
    Velocity free = travels_[i].now;
    AddTo(travels_[i].pushed, share(), &free);
    Put(travels_[i].now.linear, motions_[i].start_velocity);
    Put(travels_[i].now.angular, motions_[i].start_spin);
    Put(free.linear, motions_[i].free_velocity);
    Put(free.angular, motions_[i].free_spin);
  }
}

void Substeps::Add() {
  for (size_t i = 0; i < rows_x_.size(); ++i) rows_sum_[i] += rows_x_[i];
  for (size_t i = 0; i < joints_x_.size(); ++i) joints_sum_[i] += joints_x_[i];
  for (size_t i = 0; i < twists_x_.size(); ++i) {
    twists_sum_[i].spinning += twists_x_[i].spinning;
    for (int k = 0; k < 2; ++k) twists_sum_[i].rolling[k] += twists_x_[i].rolling[k];
  }
  for (size_t i = 0; i < points_x_.size(); ++i) {
    const ContactImpulse& x = points_x_[i];
    const Vector3d t1 = ToVector(x.direction), t2 = t1.cross(ToVector(points_[i].normal));
    const Vector3d push = x.tangential[0] * t1 + x.tangential[1] * t2;
    points_sum_[i].normal += x.normal;
    for (int k = 0; k < 3; ++k) points_sum_[i].direction[k] += static_cast<float>(push[k]);
  }
}

/// @p travelled: that the row came, and what it yielded: a soft row is not behind by that.
double Substeps::AimBoth(double target, double travelled) const {
  const double behind = target * part_ * share() - travelled;
  return target + kGain * parts_ * behind;
}

double Substeps::AimOne(double target, double travelled) const {
  if (target < 0) {
    // what is left of a gap
    const double gap = travelled - target;
    return -(gap > 0 ? 1 : kGain) * parts_ * gap;
  }
  const double behind = target * part_ * share() - travelled;
  return target + (behind > 0 ? kGain : 1) * parts_ * behind;
}

template <class AnyRow>
double Substeps::Along(const AnyRow& row, int body_a, int body_b, Velocity Travel::*what) const {
  double sum = 0;
  if (body_a != kWorld) {
    sum += Dot(ToVector(row.linear_a), ToVector(row.angular_a), travels_[body_a].*what);
  }
  if (body_b != kWorld) {
    sum += Dot(ToVector(row.linear_b), ToVector(row.angular_b), travels_[body_b].*what);
  }
  return sum;
}

void Substeps::AimRows() {
  for (size_t i = 0; i < rows_.size(); ++i) {
    Row& row = rows_[i];
    const Row& whole = whole_.rows[i];
    row.lo = whole.lo * share();
    row.hi = whole.hi * share();
    row.compliance = whole.compliance * parts_;
    const auto along = [&](Velocity Travel::*what) {
      return Along(row, row.body_a, row.body_b, what);
    };
    // a target leaves out what motions say
    const double pushed = motions_.empty() ? 0 : along(&Travel::pushed);
    const double seen = motions_.empty() ? 0 : along(&Travel::start) + pushed;
    const double target = whole.target + seen;
    double aim = target;
    if (row.parent == kNoRow && !(IsBoundedBelow(row.lo) && IsBoundedAbove(row.hi))) {
      const double travelled = along(&Travel::total) + Yielded(whole.compliance, rows_sum_[i]);
      aim = !IsBoundedBelow(row.lo) && !IsBoundedAbove(row.hi) ? AimBoth(target, travelled)
            : IsBoundedBelow(row.lo)                           ? AimOne(target, travelled)
                                                               : -AimOne(-target, -travelled);
    }
    row.target = aim - (seen - pushed * (parts_ - part_ - 1) * share());
  }
}

void Substeps::AimJoints() {
  for (const Joint& joint : whole_.joints) {
    for (int i = 0; i < joint.rows; ++i) {
      const int at = joint.first_row + i;
      const JointRow& whole = whole_.joint_rows[at];
      JointRow& row = joint_rows_[at];
      row.compliance = static_cast<float>(whole.compliance * parts_);
      const bool bounded = joint.is_bounded(i);
      if (bounded) {
        row.lo = static_cast<float>(whole.lo * share());
        row.hi = static_cast<float>(whole.hi * share());
      }
      if (is_held_[at] != 0) continue;
      JointRow seen = whole;
      if (joint.opposite) Put(-ToVector(whole.linear_a), seen.linear_b);
      const auto along = [&](Velocity Travel::*what) {
        return Along(seen, joint.body_a, joint.body_b, what);
      };
      // what damping lets the bodies keep of their free motion
      const double kept = 1 - static_cast<double>(joint.damping);
      double target = whole.target, rest = 0;
      if (kept != 0) {
        const double pushed = along(&Travel::pushed), now = along(&Travel::now);
        rest = kept * (now + pushed * share());
        target += kept * (along(&Travel::start) + pushed);
      }
      const bool below = bounded && IsBoundedBelow(row.lo);
      const bool above = bounded && IsBoundedAbove(row.hi);
      double aim = target;
      if (!(below && above)) {
        const double travelled =
            along(&Travel::total) + (joint.soft ? Yielded(whole.compliance, joints_sum_[at]) : 0);
        aim = !below && !above ? AimBoth(target, travelled)
              : below          ? AimOne(target, travelled)
                               : -AimOne(-target, -travelled);
      }
      row.target = ToFloat(aim - rest);
    }
  }
  for (const Held& held : held_) AimHeld(held);
}

void Substeps::AimHeld(const Held& held) {
  const Joint& joint = whole_.joints[held.joint];
  const int first = joint.first_row + held.row;
  const double h = whole_.time_step;
  // where the point is to the body now, and how far it came
  const auto move = [&](int body, const Vector3d& arm, Vector3d* now) -> Vector3d {
    *now = arm;
    if (body == kWorld) return Vector3d::Zero();
    const Travel& travel = travels_[body];
    *now = travel.turned * arm;
    return View(travel.total.linear) + (*now - arm) / h;
  };
  Vector3d arm_a, arm_b;
  const Vector3d moved_a = move(joint.body_a, held.arm_a, &arm_a);
  const Vector3d moved_b = move(joint.body_b, held.arm_b, &arm_b);
  const double kept = 1 - static_cast<double>(joint.damping);
  for (int k = 0; k < 3; ++k) {
    const JointRow& whole = whole_.joint_rows[first + k];
    JointRow& row = joint_rows_[first + k];
    const Vector3d a = ToVector(whole.linear_a);
    const Vector3d b = joint.opposite ? Vector3d(-a) : ToVector(whole.linear_b);
    double target = whole.target, rest = 0;
    if (kept != 0) {
      JointRow seen = whole;
      Put(b, seen.linear_b);
      const auto along = [&](const JointRow& of, Velocity Travel::*what) {
        return Along(of, joint.body_a, joint.body_b, what);
      };
      target += kept * (along(seen, &Travel::start) + along(seen, &Travel::pushed));
      Put(arm_a.cross(a), seen.angular_a);
      Put(arm_b.cross(b), seen.angular_b);
      rest = kept * (along(seen, &Travel::now) + share() * along(seen, &Travel::pushed));
    }
    if (joint.body_a != kWorld) Put(arm_a.cross(a), row.angular_a);
    if (joint.body_b != kWorld) Put(arm_b.cross(b), row.angular_b);
    const double yielded = joint.soft ? Yielded(whole.compliance, joints_sum_[first + k]) : 0;
    row.target = ToFloat(AimBoth(target, a.dot(moved_a) + b.dot(moved_b) + yielded) - rest);
  }
}

void Substeps::AimPoints() {
  const Velocity rests;
  for (const Manifold& manifold : whole_.manifolds) {
    const auto of = [&](int body, Velocity Travel::*what) -> const Velocity& {
      return body == kWorld ? rests : travels_[body].*what;
    };
    for (int p = 0; p < manifold.points; ++p) {
      const int at = manifold.first_point + p;
      const ContactPoint& whole = whole_.points[at];
      ContactPoint& point = points_[at];
      const auto apart = [&](Velocity Travel::*what) {
        return Apart(whole, of(manifold.body_a, what), of(manifold.body_b, what));
      };
      const double yielded = manifold.soft ? Yielded(whole.compliance, points_sum_[at].normal) : 0;
      double aim = AimOne(whole.bias, apart(&Travel::total) + yielded);
      point.compliance = static_cast<float>(whole.compliance * parts_);
      point.restitution = 0;
      if (whole.restitution > 0) {
        // a point bounces in the part that it is reached in, where it is
        const double now = apart(&Travel::now);
        const bool bounces = -now >= whole_.contact_law.bounce_speed && now < 0;
        const bool reached = now + apart(&Travel::pushed) * share() < aim;
        // what bounces needs not be pushed out besides
        if (bounces && reached && -now * whole.restitution > aim) {
          point.restitution = whole.restitution;
          aim = 0;
        }
      }
      point.bias = ToFloat(aim);
    }
  }
}

void Substeps::Write(const Impulses& impulses, std::span<Velocity> velocities) const {
  for (size_t i = 0; i < rows_sum_.size(); ++i) {
    const Row& row = whole_.rows[i];
    const bool own = row.parent == kNoRow;
    impulses.rows[i] = own ? std::clamp(rows_sum_[i], row.lo, row.hi) : rows_sum_[i];
  }
  for (const Joint& joint : whole_.joints) {
    for (int i = 0; i < joint.rows; ++i) {
      const int at = joint.first_row + i;
      const JointRow& row = whole_.joint_rows[at];
      const float x = joints_sum_[at];
      impulses.joint_rows[at] = joint.is_bounded(i) ? std::clamp(x, row.lo, row.hi) : x;
    }
  }
  for (const Manifold& manifold : whole_.manifolds) {
    for (int p = 0; p < manifold.points; ++p) {
      const int at = manifold.first_point + p;
      ContactImpulse& x = impulses.points[at];
      x = points_x_[at];
      const Vector3d push = ToVector(points_sum_[at].direction);
      const Vector3d t1 = ToVector(x.direction), t2 = t1.cross(ToVector(whole_.points[at].normal));
      x.normal = points_sum_[at].normal;
      x.tangential[0] = static_cast<float>(push.dot(t1));
      x.tangential[1] = manifold.tangents > 1 ? static_cast<float>(push.dot(t2)) : 0.0f;
      if (manifold.twists) impulses.twists[at] = twists_sum_[at];
    }
  }
  std::copy(velocities_.begin(), velocities_.end(), velocities.begin());
}

}  // namespace cairn
