// SPDX-License-Identifier: MIT
// Targets of a part of a step: what its rows ask for, and what they take back of what parts before
// left.
#include "cycle/substeps.h"

#include <algorithm>
#include <cmath>

#include "cairn/detail/eigen.h"
#include "problem/float_vectors.h"

namespace cairn {
namespace {

using Eigen::Vector3d;

/// Of what rows are behind, what the next part takes back. More is exact on chains, and throws
/// bodies where sweeps leave much: half of it 2 of 240 random worlds.
constexpr double kGain = 0.2;
/// Targets that floats hold.
constexpr double kMostTarget = 1e30;

/// What compliance yielded, where it is read.
double Yielded(double compliance, double impulse) { return compliance * impulse; }

float ToFloat(double value) {
  return static_cast<float>(std::clamp(value, -kMostTarget, kMostTarget));
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

}  // namespace cairn
