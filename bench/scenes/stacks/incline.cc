// SPDX-License-Identifier: MIT
#include "scenes/scene.h"

namespace cairn::bench {
namespace {

constexpr double kTilt = 0.25;                                      // [rad]
constexpr btScalar kHalfSlope = 4, kHalfThickness = btScalar(0.2);  // [m]
constexpr btScalar kHalfBox = btScalar(0.4), kPitch = 1;            // [m]
constexpr btScalar kMass = 10;                                      // [kg]
// Bullet multiplies frictions: 0.36, and what is needed is tan(0.25) = 0.26
constexpr Surface kRough = {.friction = btScalar(0.6)};

/// The middle of the slope's upper face, x upwards.
btTransform Slope() {
  return btTransform(btQuaternion(btVector3(0, 0, 1), btScalar(kTilt)), btVector3(0, 2, 0));
}

KnownFacts InclineFacts(int boxes) {
  return {.bodies = boxes,
          .top_height_m = (Slope() * btVector3(0, kHalfBox, 0)).y(),
          .mass_kg = double(kMass) * boxes};
}

/// Boxes in a row across a slope that is not steep enough for them to slide.
class Incline : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    world->AddGround(kPitch * btScalar(size) + 20);
    world->AddBox(btVector3(kHalfSlope, kHalfThickness, kPitch * btScalar(size) / 2),
                  {.pose = Slope() * At(0, -kHalfThickness, 0), .surface = kRough});
    for (int i = 0; i < size; ++i) {
      const btScalar z = kPitch * (btScalar(i) - btScalar(size - 1) / 2);
      Watch(world->AddBox(btVector3(kHalfBox, kHalfBox, kHalfBox),
                          {.mass = kMass, .pose = Slope() * At(0, kHalfBox, z), .surface = kRough}),
            kHalfBox / 2);
    }
  }
};

}  // namespace

SceneInfo InclineScene() {
  return {.name = "incline",
          .description = "Boxes at rest on a slope that friction keeps them on",
          .size_means = "boxes",
          .default_size = 1,
          .min_size = 1,
          .max_size = 50,
          .motion = SceneInfo::Motion::kComesToRest,
          .known_facts = InclineFacts,
          .make = MakeThat<Incline>};
}

}  // namespace cairn::bench
