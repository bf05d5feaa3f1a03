// SPDX-License-Identifier: MIT
#include "cycle/substeps.h"

#include <algorithm>
#include <cmath>

#include "cairn/detail/eigen.h"
#include "cycle/tension/joint_arms.h"
#include "problem/float_vectors.h"
#include "problem/joint_errors.h"

namespace cairn {
namespace {

using Eigen::Vector3d;

/// Half an angle whose sine is found at once [rad]; a larger turn is that of half of it, twice.
constexpr double kMostHalfTurn = 1;
/// What is faster turns by nobody knows what.
constexpr int kMostDoublings = 40;

void AddTo(const Velocity& change, double factor, Velocity* to) {
  View(to->linear) += factor * View(change.linear);
  View(to->angular) += factor * View(change.angular);
}

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
  joint_errors_.assign(problem.joint_errors.begin(), problem.joint_errors.end());
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
  // where there are none of them, the caller may hand in anything
  const auto take = [](const auto& of, const auto& from, auto* to) {
    to->assign(from.begin(), of.empty() ? from.begin() : from.end());
  };
  take(whole_.manifolds, start.points, &points_x_);
  take(whole_.manifolds, start.twists, &twists_x_);
  take(whole_.joints, start.joint_rows, &joints_x_);
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
          .joint_errors = joint_errors_,
          .time_step = whole_.time_step * share()};
}

bool Substeps::HasErrors(double least) const {
  const ContactProblem part = problem();
  for (const Joint& joint : part.joints) {
    for (int i = 0; i < joint.rows; ++i) {
      if (std::abs(static_cast<double>(ErrorOf(part, joint, i))) > least) return true;
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
  const ContactProblem part = problem();
  for (const Joint& joint : part.joints) {
    for (int i = 0; i < joint.rows; ++i) {
      joint_rows_[joint.first_row + i].target -= ErrorOf(part, joint, i);
    }
  }
  std::fill(joint_errors_.begin(), joint_errors_.end(), 0.0f);
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
  joint_errors_.assign(whole_.joint_errors.begin(), whole_.joint_errors.end());
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
