// SPDX-License-Identifier: MIT
// How bodies of a step move, and how hard they are to move, along a row.
#pragma once

#include <algorithm>

#include "cairn/contacts.h"
#include "cairn/detail/eigen.h"

namespace cairn {

/// Two vectors of J for one body.
struct HalfRow {
  Eigen::Vector3d linear, angular;
};

/// Velocity of a body before external impulses, and after them. Here and below: it is kWorld, or
/// one of the step's.
inline Velocity StartVelocity(const StepInput& step, int body) {
  return body == kWorld ? Velocity{} : step.bodies[body].velocity;
}

inline Velocity FreeVelocity(const StepInput& step, int body) {
  if (body == kWorld) return {};
  const Body& b = step.bodies[body];
  const Eigen::Vector3d pushed = b.inv_mass * View(b.linear_factor).cwiseProduct(View(b.impulse));
  return {.linear = View(b.velocity.linear) + pushed,
          .angular = View(b.velocity.angular) + View(b.inv_inertia) * View(b.angular_impulse)};
}

inline double Along(const HalfRow& row, const Velocity& velocity) {
  return row.linear.dot(View(velocity.linear)) + row.angular.dot(View(velocity.angular));
}

/// Its part of J M^-1 J'.
inline double Mobility(const StepInput& step, int body, const HalfRow& row) {
  if (body == kWorld) return 0;
  const Body& b = step.bodies[body];
  return b.inv_mass * View(b.linear_factor).cwiseProduct(row.linear).dot(row.linear) +
         row.angular.dot(View(b.inv_inertia) * row.angular);
}

/// What a way, or an impulse, comes to in every second of a step; 0 in one that takes no time.
inline double PerSecond(double what, double time_step) {
  return time_step > 0 ? what / time_step : 0;
}

/// The speed that uses up a way in a step, as far as anything is that fast.
inline double SpeedToPass(double way, double time_step) {
  constexpr double kFastest = 1e6;
  if (way == 0) return 0;
  return std::clamp(way / time_step, -kFastest, kFastest);
}

/// An implicit step of a spring and damper between bodies of J M^-1 J' = @p mobility.
struct SoftRow {
  double share;       ///< of the error that the step takes back
  double compliance;  ///< [1/kg]
};

inline SoftRow Soften(double frequency, double damping_ratio, double mobility, double time_step) {
  constexpr double kTwoPi = 6.283185307179586;
  // where nothing moves, or no time passes, a row gives nothing
  if (!(mobility > 0 && time_step > 0)) return {.share = 0, .compliance = 1};
  const double omega = kTwoPi * frequency;
  const double k = omega * omega / mobility, c = 2 * damping_ratio * omega / mobility;
  const double stiff = c + time_step * k;
  return {.share = time_step * k / stiff, .compliance = 1 / (time_step * stiff)};
}

inline void PutFloats(const Eigen::Vector3d& from, float* to) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<float>(from[i]);
}

}  // namespace cairn
