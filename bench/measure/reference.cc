// SPDX-License-Identifier: MIT
#include "measure/reference.h"
#include "cairn/detail/eigen.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cairn::bench {

Settings ReferenceSettings() {
  Settings settings;
  settings.tolerance = 1e-7;
  settings.max_sweeps = 20000;
  settings.k_gs = 100;
  settings.k_sm = 3;
  settings.tuning.refinements = 16;
  settings.budget = Budget::Work(std::numeric_limits<std::int64_t>::max());
  return settings;
}

std::vector<Velocity> ReadVelocities(std::span<btRigidBody* const> bodies) {
  std::vector<Velocity> velocities;
  for (const btRigidBody* body : bodies) {
    const btVector3 v = body->getLinearVelocity(), w = body->getAngularVelocity();
    velocities.push_back({.linear = {v.x(), v.y(), v.z()}, .angular = {w.x(), w.y(), w.z()}});
  }
  return velocities;
}

double VelocityError(std::span<const Velocity> a, std::span<const Velocity> b) {
  double largest = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const double difference = (View(a[i].linear) - View(b[i].linear)).norm();
    if (std::isnan(difference)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, difference);
  }
  return largest;
}

}  // namespace cairn::bench
