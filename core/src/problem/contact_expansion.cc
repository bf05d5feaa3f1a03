// SPDX-License-Identifier: MIT
#include "problem/contact_expansion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "problem/float_vectors.h"
#include "problem/whitening.h"

namespace cairn {
namespace {

using Eigen::Vector3d;

/// Points that slide slower have no direction [m^2/s^2].
constexpr double kLeastSlide = 1.1920929e-7;

double Dot(const Vector3& a, const Vector3& b) { return View(a).dot(View(b)); }

/// Of any length whose square may not fit. Zero stays zero.
Vector3d Normalized(const Vector3d& v) {
  const double square = v.squaredNorm();
  const bool fits = square > 1e-280 && square < 1e280;
  return fits ? v.normalized() : v.stableNormalized();
}

/// The first axis of the plane across n.
Vector3d FirstAxis(const Vector3d& n) {
  if (std::abs(n.z()) > std::sqrt(0.5)) return Normalized(Vector3d(0, -n.z(), n.y()));
  return Normalized(Vector3d(-n.y(), n.x(), 0));
}

/// Where a direction is on the square |x| + |y| = 1, from 1 at (1, 0) counter-clockwise to 5; 1 for
/// none.
double ToHeading(double x, double y) {
  const double length = std::abs(x) + std::abs(y);
  const double along = length > 0 && std::isfinite(length) ? x / length : 1;
  return y >= 0 ? 2 - along : 4 + along;
}

/// The impulse along the plane that a start stands for.
Vector3d PushOf(const ContactImpulse& start, const Vector3d& n) {
  const Vector3d x = FirstAxis(n), y = n.cross(x);
  const double h = start.heading, first = start.tangential[0], second = start.tangential[1];
  if (!(h >= 1 && h <= 5)) return first * x + second * y;
  const double along = h < 3 ? 2 - h : h - 4;
  const double up = h < 3 ? 1 - std::abs(along) : std::abs(along) - 1;
  const Vector3d t1 = (along * x + up * y).normalized();
  return first * t1 + second * t1.cross(n);
}

/// Velocities of a body before and after its external impulses.
struct Motion {
  Velocity start, free;
};

Motion MotionOf(std::span<const Body> bodies, int body) {
  Motion motion;
  WhitenedBody whitened;
  if (body == kWorld || !Whiten(bodies[body], &whitened)) return motion;
  return {.start = bodies[body].velocity, .free = whitened.free};
}

Motion ToMotion(const ContactMotion& from) {
  return {.start = {ToVector(from.start_velocity), ToVector(from.start_spin)},
          .free = {ToVector(from.free_velocity), ToVector(from.free_spin)}};
}

/// What joints and contacts see of the motion of a body.
Motion SeenMotion(const ContactProblem& problem, int body) {
  const bool own = problem.motions.empty() || body == kWorld;
  return own ? MotionOf(problem.bodies, body) : ToMotion(problem.motions[body]);
}

/// What external impulses add to the speed of a body.
double Pushed(const Motion& motion) {
  return (View(motion.free.linear) - View(motion.start.linear)).norm();
}

Vector3d VelocityAt(const Velocity& velocity, const Vector3d& arm) {
  return View(velocity.linear) + View(velocity.angular).cross(arm);
}

}  // namespace

/// Directions of a point and the targets along them.
struct ContactExpansion::Point {
  Vector3d direction[3];  ///< normal, t1, t2
  double target[3];
  double friction[3];    ///< coefficients along them
  Vector3d unseen_spin;  ///< relative, of the bodies less what friction sees
};

ContactExpansion::ContactExpansion(const ContactProblem& problem, const Impulses& start)
    : bodies_(problem.bodies),
      motions_(problem.motions),
      rows_(problem.rows.begin(), problem.rows.end()),
      impulses_(start.rows.begin(), start.rows.end()),
      given_(rows_.size()),
      joints_(problem.joints.begin(), problem.joints.end()),
      manifolds_(problem.manifolds.begin(), problem.manifolds.end()) {
  for (const Joint& joint : joints_) Add(joint, problem, start);
  for (const Manifold& manifold : manifolds_) Add(manifold, problem, start);
}

void ContactExpansion::Add(const Joint& joint, const ContactProblem& problem,
                           const Impulses& start) {
  const Motion own_a = MotionOf(bodies_, joint.body_a), own_b = MotionOf(bodies_, joint.body_b);
  const Motion a = SeenMotion(problem, joint.body_a), b = SeenMotion(problem, joint.body_b);
  for (int i = joint.first_row; i < joint.first_row + joint.rows; ++i) {
    const JointRow& from = problem.joint_rows[i];
    Row& row = rows_.emplace_back();
    row.body_a = joint.body_a;
    row.body_b = joint.body_b;
    row.linear_a = ToVector(from.linear_a);
    row.angular_a = ToVector(from.angular_a);
    row.linear_b = joint.opposite ? Vector3d(-View(row.linear_a)) : ToVector(from.linear_b);
    row.angular_b = ToVector(from.angular_b);
    const auto along = [&row](const Motion& of_a, const Motion& of_b) {
      return Dot(row.linear_a, of_a.free.linear) + Dot(row.angular_a, of_a.free.angular) +
             Dot(row.linear_b, of_b.free.linear) + Dot(row.angular_b, of_b.free.angular);
    };
    // targets are for velocities as the bodies have them
    row.target = from.target - joint.damping * along(a, b) + along(own_a, own_b);
    row.compliance = joint.soft ? from.compliance : 0;
    if (joint.is_bounded(i - joint.first_row)) {
      row.lo = from.lo;
      row.hi = from.hi;
    }
    row.host = joint.host;
    impulses_.push_back(start.joint_rows[i]);
  }
}

ContactExpansion::Point ContactExpansion::Aim(const Manifold& manifold, const ContactPoint& point,
                                              const ContactProblem& problem) const {
  const ContactLaw& law = problem.contact_law;
  const Motion a = SeenMotion(problem, manifold.body_a), b = SeenMotion(problem, manifold.body_b);
  const Vector3d arm_a = ToVector(point.arm_a), arm_b = ToVector(point.arm_b);
  const Vector3d n = ToVector(point.normal), given = ToVector(point.tangent);
  const auto relative = [&](const Velocity& of_a, const Velocity& of_b) -> Vector3d {
    return VelocityAt(of_a, arm_a) - VelocityAt(of_b, arm_b);
  };
  const Vector3d free = relative(a.free, b.free), start = relative(a.start, b.start);
  const Vector3d own =
      relative(MotionOf(bodies_, manifold.body_a).free, MotionOf(bodies_, manifold.body_b).free);

  const double approach = -n.dot(start);
  const bool bounces = std::abs(approach) >= law.bounce_speed;
  const double bounce = bounces ? std::max(0.0, point.restitution * approach) : 0;
  const Vector3d slide = free - n.dot(free) * n;
  const bool slides = slide.squaredNorm() > kLeastSlide;
  const Vector3d t1 = !given.isZero(0) ? given : slides ? Normalized(slide) : FirstAxis(n);
  const Vector3d t2 = t1.cross(n);
  const bool less = slides && given.isZero(0) && !law.host.bounded_apart;
  const double stopped = point.friction * std::max(-n.dot(free), std::max(Pushed(a), Pushed(b)));
  const double share = less ? std::min(1.0, stopped / slide.norm()) : 1;

  // targets are for velocities as the bodies have them
  const Velocity a_slides{a.free.linear,
                          law.host.spin_before_torques ? a.start.angular : a.free.angular};
  const Velocity b_slides{b.free.linear,
                          law.host.spin_before_torques ? b.start.angular : b.free.angular};
  const Vector3d unseen = own - relative(a_slides, b_slides);
  const Vector3d own_spin = View(MotionOf(bodies_, manifold.body_a).free.angular) -
                            View(MotionOf(bodies_, manifold.body_b).free.angular);
  return {{n, t1, t2},
          {point.bias + bounce + n.dot(own - free), t1.dot(unseen), t2.dot(unseen)},
          {0, point.friction, point.friction * share},
          own_spin - (View(a_slides.angular) - View(b_slides.angular))};
}

void ContactExpansion::Add(const Manifold& manifold, const ContactProblem& problem,
                           const Impulses& start) {
  Array<Row> frictions;
  Array<double> starts;
  const int first = static_cast<int>(rows_.size());
  for (int p = 0; p < manifold.points; ++p) {
    const ContactPoint& point = problem.points[manifold.first_point + p];
    const ContactImpulse& last = start.points[manifold.first_point + p];
    const Point aimed = Aim(manifold, point, problem);
    const Vector3d arm_a = ToVector(point.arm_a), arm_b = ToVector(point.arm_b);
    const auto row = [&](int k) {
      const Vector3d& d = aimed.direction[k];
      return Row{.body_a = manifold.body_a,
                 .body_b = manifold.body_b,
                 .linear_a = d,
                 .angular_a = arm_a.cross(d),
                 .linear_b = -d,
                 .angular_b = d.cross(arm_b),
                 .target = aimed.target[k],
                 .host = manifold.host};
    };
    rows_.push_back(row(0));
    rows_.back().lo = 0;
    rows_.back().compliance = manifold.soft ? point.compliance : 0;
    impulses_.push_back(last.normal);

    const Vector3d push = PushOf(last, aimed.direction[0]);
    for (int k = 1; k <= manifold.tangents; ++k) {
      frictions.push_back(row(k));
      frictions.back().parent = first + p;
      frictions.back().friction = aimed.friction[k];
      starts.push_back(push.dot(aimed.direction[k]));
    }
    directions_.push_back({aimed.direction[0], aimed.direction[1]});
  }
  rows_.insert(rows_.end(), frictions.begin(), frictions.end());
  impulses_.insert(impulses_.end(), starts.begin(), starts.end());
  if (manifold.twists) AddTwists(manifold, problem, start.twists, first);
}

void ContactExpansion::AddTwists(const Manifold& manifold, const ContactProblem& problem,
                                 std::span<const TwistImpulse> start, int first) {
  for (int p = 0; p < manifold.points; ++p) {
    const size_t index = static_cast<size_t>(manifold.first_point) + p;
    const ContactTwist& twist = problem.twists[index];
    const Point aimed = Aim(manifold, problem.points[index], problem);
    const Vector3d& n = aimed.direction[0];
    const Vector3d axes[] = {n, FirstAxis(n), n.cross(FirstAxis(n))};
    const TwistImpulse& last = start[index];
    const float starts[] = {last.spinning, last.rolling[0], last.rolling[1]};
    for (int k = 0; k < Manifold::kTwistRows; ++k) {
      const double most = k == 0 ? twist.most_spinning : twist.most_rolling;
      rows_.push_back({.body_a = manifold.body_a,
                       .body_b = manifold.body_b,
                       .angular_a = axes[k],
                       .angular_b = -axes[k],
                       .target = axes[k].dot(aimed.unseen_spin),
                       .lo = -most,
                       .hi = most,
                       .parent = first + p,
                       .friction = k == 0 ? twist.spinning : twist.rolling,
                       .host = manifold.host});
      impulses_.push_back(starts[k]);
    }
  }
}

void ContactExpansion::Write(const Impulses& impulses) const {
  auto next = impulses_.begin() + static_cast<std::ptrdiff_t>(given_);
  std::copy(impulses_.begin(), next, impulses.rows.begin());
  for (const Joint& joint : joints_) {
    for (int i = 0; i < joint.rows; ++i) {
      impulses.joint_rows[joint.first_row + i] = static_cast<float>(*next++);
    }
  }
  auto direction = directions_.begin();
  for (const Manifold& manifold : manifolds_) {
    const auto friction = next + manifold.points;
    for (int p = 0; p < manifold.points; ++p) {
      ContactImpulse& to = impulses.points[manifold.first_point + p];
      to = {.normal = static_cast<float>(next[p])};
      for (int k = 0; k < manifold.tangents; ++k) {
        to.tangential[k] = static_cast<float>(friction[p * manifold.tangents + k]);
      }
      const auto& [n, t1] = *direction++;
      if (manifold.tangents == 0) continue;
      for (int k = 0; k < 3; ++k) to.direction[k] = static_cast<float>(t1[k]);
      const Vector3d axis = FirstAxis(n);
      to.heading = static_cast<float>(ToHeading(t1.dot(axis), t1.dot(n.cross(axis))));
    }
    auto twist = friction + manifold.points * manifold.tangents;
    for (int p = 0; p < manifold.points && manifold.twists; ++p) {
      TwistImpulse& to = impulses.twists[manifold.first_point + p];
      to.spinning = static_cast<float>(*twist++);
      for (float& x : to.rolling) x = static_cast<float>(*twist++);
    }
    next += manifold.rows();
  }
}

}  // namespace cairn
