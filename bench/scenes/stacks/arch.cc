// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/scene.h"

namespace cairn::bench {
namespace {

// Of the faces before Bullet adds its margin, which the corners leave room for.
constexpr double kInner = 2, kOuter = 2.6, kDepth = 0.8;  // radii, width of the arch [m]
constexpr double kMargin = 0.04;                          // Bullet's, of convex hulls [m]
constexpr btScalar kMass = 50;                            // of a stone [kg]
constexpr double kPi = 3.14159265358979;

/// One of the wedges that a half ring is cut into.
struct Stone {
  explicit Stone(int stones) : half_angle(kPi / (2 * stones)) {
    const double tangent = std::tan(half_angle), inner = kInner * tangent, outer = kOuter * tangent;
    centre = kInner + (kOuter - kInner) / 3 * (inner + 2 * outer) / (inner + outer);
  }

  /// Half the width at a distance from the middle of the ring, less the margin [m].
  double HalfWidth(double radius) const {
    return (radius * std::sin(half_angle) - kMargin) / std::cos(half_angle);
  }

  /// About the centre of mass, y outwards.
  std::array<btVector3, 8> Corners() const {
    std::array<btVector3, 8> corners;
    auto corner = corners.begin();
    for (const double radius : {kInner + kMargin, kOuter - kMargin}) {
      for (const double x : {-HalfWidth(radius), HalfWidth(radius)}) {
        for (const double z : {kMargin - kDepth / 2, kDepth / 2 - kMargin}) {
          *corner++ = btVector3(btScalar(x), btScalar(radius - centre), btScalar(z));
        }
      }
    }
    return corners;
  }

  /// From the vertical, of stone i from the left [rad].
  double Angle(int i) const { return kPi / 2 - half_angle * (2 * i + 1); }

  double half_angle;  ///< [rad]
  double centre;      ///< Of mass, from the middle of the ring [m].
};

KnownFacts ArchFacts(int stones) {
  const Stone stone(stones);
  return {.bodies = stones,
          // the one in the middle, or those beside it
          .top_height_m = stone.centre * std::cos(stone.Angle(stones / 2)),
          .mass_kg = double(kMass) * stones};
}

/// A half ring that stands on the ground with its first stone and its last.
class Arch : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    world->AddGround(20);
    const Stone stone(size);
    const std::array<btVector3, 8> corners = stone.Corners();
    for (int i = 0; i < size; ++i) {
      const btQuaternion turn(btVector3(0, 0, 1), btScalar(stone.Angle(i)));
      const btTransform pose(turn, quatRotate(turn, btVector3(0, btScalar(stone.centre), 0)));
      world->AddConvexHull(corners,
                           {.mass = kMass, .pose = pose, .surface = {.friction = btScalar(0.9)}});
    }
    Watch(world->dynamic_bodies()[size / 2], btScalar(kOuter - kInner) / 2);
  }
};

}  // namespace

SceneInfo ArchScene() {
  return {.name = "arch",
          .description = "An arch of convex stones without mortar",
          .size_means = "stones",
          .default_size = 11,
          .min_size = 5,
          .max_size = 31,
          .motion = SceneInfo::Motion::kComesToRest,
          .known_facts = ArchFacts,
          .make = MakeThat<Arch>};
}

}  // namespace cairn::bench
