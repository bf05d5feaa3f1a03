// SPDX-License-Identifier: MIT
#include "run/frame_facts.h"

#include <algorithm>

#include "scenes/facts.h"

namespace cairn::cli {

FrameFacts ReadFrameFacts(const bench::Scene& scene, const bench::World& world) {
  const bench::SceneFacts facts = scene.Measure(world);
  return {.energy = bench::TotalEnergy(world),
          .penetration = facts.penetration_m,
          .height_lost = facts.height_lost_m,
          .joint_gap = facts.joint_gap_m,
          .contacts = bench::ContactPoints(world)};
}

double MassRatio(const bench::World& world) {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const btRigidBody* body : world.dynamic_bodies()) {
    const double mass = body->getMass();
    least = std::min(least, mass);
    most = std::max(most, mass);
  }
  return most > 0 ? most / least : kNotMeasured;
}

}  // namespace cairn::cli
