// SPDX-License-Identifier: MIT
// Angles from operations that are the same to the bit with every compiler and C library.
#pragma once

#include <cmath>

namespace cairn {

inline constexpr double kPi = 3.141592653589793;

/// The arc tangent of t >= 0: halved three times, then its series; within 1e-15.
inline double ArcTan(double t) {
  int halved = 0;
  for (; halved < 3; ++halved) t = t / (1 + std::sqrt(1 + t * t));
  const double s = t * t;
  double sum = 0;
  for (int n = 15; n > 0; n -= 2) sum = 1.0 / n - s * sum;
  return 8 * t * sum;
}

/// The angle of the point (x, y) in (-pi, pi]; 0 for (0, 0).
inline double ArcTan2(double y, double x) {
  const double up = std::abs(y), along = std::abs(x);
  if (up == 0 && along == 0) return 0;
  const double first = up <= along ? ArcTan(up / along) : kPi / 2 - ArcTan(along / up);
  const double angle = x < 0 ? kPi - first : first;
  return y < 0 ? -angle : angle;
}

/// The same angle in (-pi, pi]. @pre it is in [-2 pi, 2 pi]
inline double WrapAngle(double angle) {
  if (angle > kPi) return angle - 2 * kPi;
  return angle <= -kPi ? angle + 2 * kPi : angle;
}

}  // namespace cairn
