// SPDX-License-Identifier: MIT
#include "verify/plain_world.h"
#include "cairn/detail/eigen.h"

#include <cmath>

namespace cairn::verify {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kStep = 1 / 60.0;  // [s]
constexpr double kGravity = 9.81;   // [m/s^2]
constexpr double kNear = 0.02;      // points this far off a face, or beside it, count [m]

double Dot(const Vector3d& a, const Vector3d& b) {
  return a.x() * b.x() + a.y() * b.y() + a.z() * b.z();
}

Body ToBody(const Thing& thing, std::uint64_t id) {
  Body body{.velocity = thing.velocity, .id = id};
  if (thing.mass == 0) return body;
  body.inv_mass = 1 / thing.mass;
  body.impulse = Vector3d(0, -thing.mass * kGravity * kStep, 0);
  Vector3d moment = Vector3d::Constant(0.4 * thing.mass * thing.radius * thing.radius);
  if (thing.radius == 0) {
    const double xx = thing.half.x() * thing.half.x(), yy = thing.half.y() * thing.half.y();
    const double zz = thing.half.z() * thing.half.z();
    moment = Vector3d(yy + zz, zz + xx, xx + yy) * (thing.mass / 3);
  }
  const Matrix3d axes = thing.turn.Axes();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      double sum = 0;
      for (int k = 0; k < 3; ++k) sum += axes(i, k) / moment[k] * axes(j, k);
      body.inv_inertia(i, j) = sum;
    }
  }
  return body;
}

Vector3d Turned(const Matrix3d& axes, const Vector3d& v) {
  return {axes(0, 0) * v.x() + axes(0, 1) * v.y() + axes(0, 2) * v.z(),
          axes(1, 0) * v.x() + axes(1, 1) * v.y() + axes(1, 2) * v.z(),
          axes(2, 0) * v.x() + axes(2, 1) * v.y() + axes(2, 2) * v.z()};
}

/// Corner @p i of 8 of a box.
Vector3d Corner(const Thing& box, const Matrix3d& axes, std::uint32_t i) {
  const Vector3d local((i & 1 ? 1 : -1) * box.half.x(), (i & 2 ? 1 : -1) * box.half.y(),
                       (i & 4 ? 1 : -1) * box.half.z());
  return box.position + Turned(axes, local);
}

JointSide SideOf(const std::vector<Thing>& things, int thing, const Vector3d& anchor) {
  if (thing < 0) return {.anchor = anchor};
  const Matrix3d axes = things[thing].turn.Axes();
  const Vector3d& centre = things[thing].position;
  return {.body = thing, .centre = centre, .anchor = centre + Turned(axes, anchor), .axes = axes};
}

}  // namespace

Matrix3d Turn::Axes() const {
  Matrix3d axes;
  axes << 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),  //
      2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),      //
      2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y);
  return axes;
}

Turn Turn::Moved(const Vector3d& by) const {
  const double a = by.x() / 2, b = by.y() / 2, c = by.z() / 2;
  Turn moved{w - a * x - b * y - c * z, x + a * w + b * z - c * y, y + b * w + c * x - a * z,
             z + c * w + a * y - b * x};
  const double length =
      std::sqrt(moved.w * moved.w + moved.x * moved.x + moved.y * moved.y + moved.z * moved.z);
  return {moved.w / length, moved.x / length, moved.y / length, moved.z / length};
}

void PlainWorld::TouchGround(int thing) {
  const Thing& a = things[thing];
  found_.clear();
  if (a.radius > 0) {
    const double depth = a.radius - a.position.y();
    if (depth > -kNear) found_.push_back({Vector3d(a.position.x(), 0, a.position.z()), depth, 0});
  } else {
    const Matrix3d axes = a.turn.Axes();
    for (std::uint32_t i = 0; i < 8; ++i) {
      const Vector3d corner = Corner(a, axes, i);
      if (corner.y() < kNear) found_.push_back({corner, -corner.y(), i});
    }
  }
  const auto id = static_cast<std::uint64_t>(thing) + 1;
  contacts_.Add({.body_a = thing, .centre_a = a.position, .id = id << 32}, found_);
}

/// Corners of the upper box at the top of the lower one.
void PlainWorld::TouchBoxes(int upper, int lower) {
  const Thing &a = things[upper], &b = things[lower];
  const Matrix3d axes = a.turn.Axes(), below = b.turn.Axes();
  const Vector3d normal = below.col(1);
  found_.clear();
  for (std::uint32_t i = 0; i < 8; ++i) {
    const Vector3d corner = Corner(a, axes, i), from = corner - b.position;
    const double depth = b.half.y() - Dot(from, normal);
    const bool over = std::abs(Dot(from, below.col(0))) < b.half.x() + kNear &&
                      std::abs(Dot(from, below.col(2))) < b.half.z() + kNear;
    if (over && depth > -kNear && depth < b.half.y()) found_.push_back({corner, depth, i});
  }
  if (found_.empty()) return;
  const std::uint64_t id = (static_cast<std::uint64_t>(upper) + 1) << 32 | (lower + 1u);
  contacts_.Add({upper, lower, a.position, b.position, normal, 0.6, 0, id}, found_);
}

void PlainWorld::TouchBalls(int first, int second) {
  const Thing &a = things[first], &b = things[second];
  const Vector3d apart = a.position - b.position;
  const double reach = a.radius + b.radius + kNear, squared = Dot(apart, apart);
  if (squared > reach * reach || squared == 0) return;
  const double distance = std::sqrt(squared);
  const Vector3d normal = apart / distance;
  found_.assign(1, {b.position + b.radius * normal, a.radius + b.radius - distance, 0});
  const std::uint64_t id = (static_cast<std::uint64_t>(first) + 1) << 32 | (second + 1u);
  contacts_.Add({first, second, a.position, b.position, normal, 0.4, 0.2, id}, found_);
}

void PlainWorld::FindContacts() {
  for (int a = 0; a < static_cast<int>(things.size()); ++a) {
    if (things[a].mass > 0) TouchGround(a);
    for (int b = 0; b < a; ++b) {
      if (things[a].mass + things[b].mass == 0) continue;
      if ((things[a].radius > 0) != (things[b].radius > 0)) continue;
      things[a].radius > 0 ? TouchBalls(a, b) : TouchBoxes(a, b);
    }
  }
}

void PlainWorld::Step() {
  std::vector<Body> bodies;
  for (size_t i = 0; i < things.size(); ++i) bodies.push_back(ToBody(things[i], i + 1));
  const StepInput step{.bodies = bodies, .time_step = kStep};
  contacts_.Begin(step);
  FindContacts();
  joints_.Begin(step);
  for (size_t i = 0; i < pins.size(); ++i) {
    const Pin& pin = pins[i];
    joints_.Add(BallJoint(), SideOf(things, pin.a, pin.in_a), SideOf(things, pin.b, pin.in_b),
                i + 1);
  }
  std::vector<Velocity> velocities(bodies.size());
  const Report report =
      solver_.Solve(ProblemOf(step, contacts_, joints_), StartOf(&contacts_, &joints_), velocities);
  if (!report.ok()) return;  // nothing moves any more, which the hash shows
  for (size_t i = 0; i < things.size(); ++i) {
    Thing& thing = things[i];
    thing.velocity = velocities[i];
    thing.position += kStep * View(velocities[i].linear);
    thing.turn = thing.turn.Moved(kStep * View(velocities[i].angular));
  }
}

void PlainWorld::AddTo(Hash* hash) {
  for (const Thing& thing : things) {
    const Turn& turn = thing.turn;
    for (const double number : {turn.w, turn.x, turn.y, turn.z}) hash->Add(number);
    for (int i = 0; i < 3; ++i) {
      hash->Add(thing.position[i]);
      hash->Add(thing.velocity.linear[i]);
      hash->Add(thing.velocity.angular[i]);
    }
  }
  for (const ContactImpulse& impulse : contacts_.impulses()) {
    for (const float number : {impulse.normal, impulse.tangential[0], impulse.tangential[1]}) {
      hash->Add(number);
    }
  }
  for (const float impulse : joints_.impulses()) hash->Add(impulse);
}

}  // namespace cairn::verify
