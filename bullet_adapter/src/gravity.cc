// SPDX-License-Identifier: MIT
#include "gravity.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cmath>

#include "body_table.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

constexpr double kOnEarth = 9.81;  ///< [m/s^2]
/// So many bodies are asked, for worlds in which nothing falls.
constexpr size_t kAsked = 16;
/// 2^16 units are 0.015 mm.
constexpr int kMostDoublings = 16;

}  // namespace

btScalar GravityOf(const btCollisionObject* object) {
  const btRigidBody* const rigid = btRigidBody::upcast(object);
  return rigid != nullptr && Reacts(*rigid) ? rigid->getGravity().length() : btScalar(0);
}

double UnitsPerMetre(std::span<btCollisionObject* const> bodies) {
  double most = 0;
  for (const btCollisionObject* const body : bodies.first(std::min(bodies.size(), kAsked))) {
    const double ratio = static_cast<double>(GravityOf(body)) / kOnEarth;
    if (ratio > most && ratio < HUGE_VAL) most = ratio;
    // as on earth: others are not asked
    if (most * most > 0.5 && most * most < 2) return 1;
  }
  if (most == 0) return 1;
  int doublings = 0;  // most is in [0.5, 1) 2^doublings
  const double rest = std::frexp(most, &doublings);
  if (rest * rest < 0.5) --doublings;  // to the nearest power
  return std::ldexp(1.0, std::clamp(doublings, -kMostDoublings, kMostDoublings));
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
