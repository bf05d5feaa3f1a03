// SPDX-License-Identifier: MIT
#include "cairn/contacts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "engine/room.h"
#include "engine/step_body.h"

namespace cairn {
namespace {

using Eigen::Vector3d;

/// Of a ContactImpulse.
constexpr int kNumbers = 7;

/// What a normal row asks for.
struct Normal {
  double bias;
  double compliance;
  bool is_speed;  ///< bias is to be kept, and takes back no depth
};

/// How a point moves along its normal.
struct Approach {
  double start;     ///< v0 [m/s], below 0 towards each other
  double free;      ///< after external impulses
  double mobility;  ///< J M^-1 J' [1/kg]
};

/// A step, and the parts it is made in.
struct Steps {
  double h;
  int parts;
};

/// Speed to leave with, so that the energy E of contacts.h is e^2 times that before. The body keeps
/// it to the end of the step, part by part.
double BounceSpeed(double restitution, const Approach& approach, double gap, const Steps& steps) {
  const double pressed = std::max(0.0, approach.start - approach.free);  // g' h
  const double fall = PerSecond(pressed, steps.h), of_part = pressed / steps.parts;
  const double before = approach.start - of_part / 2;
  const double energy = std::max(0.0, before * before / 2 + fall * gap);
  const double after = restitution * restitution * energy - fall * gap;
  const double way = pressed - of_part / 2;  // pressed / 2 of one part
  const double more = steps.parts == 1 ? 0 : way * way - of_part * of_part / 4;
  return std::sqrt(2 * std::max(0.0, after) + more) - way;
}

Normal NormalOf(const ContactOptions& options, double restitution, const Approach& approach,
                double depth, const Steps& steps) {
  const double h = steps.h;
  Normal row{.bias = SpeedToPass(depth, h), .compliance = 0, .is_speed = false};
  if (depth >= 0) {
    const double frequency = std::min(options.frequency, 0.25 / h);
    const SoftRow soft = frequency > 0
                             ? Soften(frequency, options.damping_ratio, approach.mobility, h)
                             : SoftRow{.share = options.erp, .compliance = 0};
    const double back = soft.share * std::max(0.0, depth - options.slop);
    row.bias = std::min(options.max_push, PerSecond(back, h));
    row.compliance = soft.compliance;
    row.is_speed = frequency > 0;
  }
  const bool bounces = restitution > 0 && -approach.start >= options.min_bounce &&
                       -approach.start > 0 && h * approach.free <= depth;
  if (!bounces) return row;
  const double bounce = BounceSpeed(restitution, approach, -depth, steps);
  return {.bias = std::max(row.bias, bounce), .compliance = 0, .is_speed = true};
}

}  // namespace

Contacts::Contacts(const ContactOptions& options, Memory* memory)
    : options_(options), manifolds_(memory), points_(memory), impulses_(memory), memory_(memory) {}

void Contacts::Begin(const StepInput& step) {
  static_assert(sizeof(ContactImpulse) == kNumbers * sizeof(float));
  const float* const last = impulses_.empty() ? nullptr : &impulses_[0].normal;
  memory_.Begin({last, kNumbers * impulses_.size()}, step.bodies, step.time_step);
  step_ = step;
  deepest_ = {};
  refused_ = {};
  manifolds_.clear();
  points_.clear();
  impulses_.clear();
}

bool Contacts::Add(const Touch& touch, std::span<const TouchPoint> points) {
  refused_ = detail::FindBad(options_, "options");
  if (!refused_) refused_ = detail::FindBad(touch, points, static_cast<int>(step_.bodies.size()));
  if (refused_) return false;
  MakeRoom(points.size() / Manifold::kMostPoints + 1, &manifolds_);
  MakeRoom(points.size(), &points_);
  MakeRoom(points.size(), &impulses_);
  memory_.Reserve(points.size());
  Manifold* manifold = nullptr;
  for (const TouchPoint& point : points) {
    if (-point.depth > options_.max_gap) continue;
    if (manifold == nullptr || manifold->points == Manifold::kMostPoints) {
      manifold = &manifolds_.emplace_back();
      manifold->body_a = touch.body_a;
      manifold->body_b = touch.body_b;
      manifold->first_point = static_cast<int>(points_.size());
      manifold->points = 0;
      manifold->tangents = touch.friction > 0 ? 2 : 0;
      manifold->soft = options_.frequency > 0;
    }
    AddPoint(touch, point, manifold);
    ContactImpulse& impulse = impulses_.emplace_back();
    const auto start = memory_.Add({touch.id, point.feature}, touch.body_a, touch.body_b, kNumbers);
    if (start.impulses == nullptr) continue;
    std::copy_n(start.impulses, kNumbers, &impulse.normal);
    impulse.normal *= start.share;
    for (float& tangential : impulse.tangential) tangential *= start.share;
  }
  return true;
}

void Contacts::AddPoint(const Touch& touch, const TouchPoint& from, Manifold* manifold) {
  const auto arm = [&from](int body, const Vector3d& centre) -> Vector3d {
    if (body == kWorld) return Vector3d::Zero();
    return View(from.position) - centre;
  };
  const Vector3d arm_a = arm(touch.body_a, touch.centre_a);
  const Vector3d arm_b = arm(touch.body_b, touch.centre_b);
  const auto normal = View(touch.normal);
  const HalfRow a{normal, arm_a.cross(normal)};
  const HalfRow b{-normal, -arm_b.cross(normal)};
  const Approach approach{
      .start = Along(a, StartVelocity(step_, touch.body_a)) +
               Along(b, StartVelocity(step_, touch.body_b)),
      .free =
          Along(a, FreeVelocity(step_, touch.body_a)) + Along(b, FreeVelocity(step_, touch.body_b)),
      .mobility = Mobility(step_, touch.body_a, a) + Mobility(step_, touch.body_b, b)};
  const Normal row = NormalOf(options_, touch.restitution, approach, from.depth,
                              {step_.time_step, std::max(1, step_.substeps)});
  if (from.depth > deepest_.largest) {
    deepest_ = {from.depth, std::clamp(row.bias * step_.time_step, 0.0, from.depth)};
  }

  if (row.is_speed) manifold->speeds |= static_cast<std::uint8_t>(1 << manifold->points);
  ++manifold->points;
  ContactPoint& point = points_.emplace_back();
  PutFloats(arm_a, point.arm_a);
  PutFloats(arm_b, point.arm_b);
  PutFloats(touch.normal, point.normal);
  point.bias = static_cast<float>(row.bias);
  point.friction = static_cast<float>(touch.friction);
  point.compliance = static_cast<float>(row.compliance);
}

}  // namespace cairn
