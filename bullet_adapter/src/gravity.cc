// SPDX-License-Identifier: MIT
#include "gravity.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "body_table.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

constexpr double kOnEarth = 9.81;  ///< [m/s^2]
/// So many bodies are asked, one in so many of all.
constexpr size_t kAsked = 16;
/// 2^16 units are 0.015 mm.
constexpr int kMostDoublings = 16;

}  // namespace

btScalar GravityOf(const btCollisionObject* object) {
  const btRigidBody* const rigid = btRigidBody::upcast(object);
  return rigid != nullptr && Reacts(*rigid) ? rigid->getGravity().length() : btScalar(0);
}

double UnitsPerMetre(std::span<btCollisionObject* const> bodies) {
  // by the middle one of some, or the larger of two: a few may have a gravity of their own, as
  // magnets, missiles and balloons have
  std::array<double, kAsked> ratios;
  size_t count = 0;
  const size_t asked = std::min(bodies.size(), kAsked);
  for (size_t i = 0; i < asked; ++i) {
    const double ratio =
        static_cast<double>(GravityOf(bodies[i * bodies.size() / asked])) / kOnEarth;
    if (ratio > 0 && ratio < HUGE_VAL) ratios[count++] = ratio;
  }
  if (count == 0) return 1;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(ratios.begin(), middle, ratios.begin() + static_cast<std::ptrdiff_t>(count));
  int doublings = 0;  // it is in [0.5, 1) 2^doublings
  const double rest = std::frexp(*middle, &doublings);
  if (rest * rest < 0.5) --doublings;  // to the nearest power
  return std::ldexp(1.0, std::clamp(doublings, -kMostDoublings, kMostDoublings));
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
