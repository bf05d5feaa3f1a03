// SPDX-License-Identifier: MIT
#include "scenes/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "scenes/facts.h"
#include "scenes/random.h"

namespace cairn::bench {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kLargestDisplacement = 1e-4;  // [m]

/// A little less than the largest in the cube's corners: rounding of positions must not exceed it.
void Displace(World* world, std::uint64_t seed) {
  const double reach = 0.9 * kLargestDisplacement / std::sqrt(3.0);
  Random random(seed);
  for (btRigidBody* body : world->dynamic_bodies()) {
    const btVector3 offset = random.InCube(reach);
    btTransform pose = body->getCenterOfMassTransform();
    pose.setOrigin(pose.getOrigin() + offset);
    body->setCenterOfMassTransform(pose);
  }
}

}  // namespace

void Scene::Build(World* world, const SceneOptions& options) {
  const int size = options.size == 0 ? info_.default_size : options.size;
  if (size < info_.min_size || size > info_.max_size) {
    throw std::out_of_range("scene " + std::string(info_.name) + ": size " + std::to_string(size) +
                            " is not within [" + std::to_string(info_.min_size) + ", " +
                            std::to_string(info_.max_size) + "]");
  }
  world->SetFrictionDirections(options.friction_directions);
  AddBodies(world, size);
  if (options.seed != 0) Displace(world, options.seed);
  for (Watched& watched : watched_) watched.built_at = watched.Height();
}

void Scene::BeforeStep(World*, int) {}

void Scene::Watch(const btRigidBody* body, btScalar may_sink) {
  watched_.push_back({.body = body, .built_at = 0, .may_sink = may_sink});
}

double Scene::HeightLost(const World&) const {
  double sum = 0;
  for (const Watched& watched : watched_) sum += watched.Sunk();
  return watched_.empty() ? kNone : sum / static_cast<double>(watched_.size());
}

SceneFacts Scene::Measure(const World& world) const {
  SceneFacts facts;
  facts.height_lost_m = HeightLost(world);
  facts.joint_gap_m = LargestJointGap(world);
  facts.penetration_m = MaxPenetration(world);
  facts.speed_at_rest_m_s =
      info_.motion == SceneInfo::Motion::kComesToRest ? LargestSpeed(world) : kNone;
  if (!watched_.empty()) {
    const auto fallen = std::count_if(watched_.begin(), watched_.end(), [](const Watched& watched) {
      return !(watched.Sunk() <= watched.may_sink);  // NaN has fallen too
    });
    const double share = static_cast<double>(fallen) / static_cast<double>(watched_.size());
    facts.verdict =
        share <= MayFall() ? SceneFacts::Verdict::kStanding : SceneFacts::Verdict::kFallen;
  }
  return facts;
}

}  // namespace cairn::bench
