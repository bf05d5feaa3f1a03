// SPDX-License-Identifier: MIT
#include "scenes/scene.h"
#include "scenes/stacks/square.h"

namespace cairn::bench {
namespace {

constexpr btScalar kRadius = btScalar(0.4), kPitch = btScalar(1.2);  // [m]
constexpr btScalar kMass = 1;                                        // [kg]
constexpr btScalar kSpeed = 1;                                       // [m/s]

KnownFacts BallsFacts(int balls) {
  return {.bodies = balls, .top_height_m = kRadius, .mass_kg = double(kMass) * balls};
}

/// They roll the same way at the same speed, so that none ever touches another.
class Balls : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    const int side = PlacesPerSide(size);
    const btScalar first = -btScalar(side - 1) / 2 * kPitch;
    world->AddGround(kPitch * btScalar(side) / 2 + 100);
    for (int i = 0; i < size; ++i) {
      const btTransform pose =
          At(first + btScalar(i % side) * kPitch, kRadius, first + btScalar(i / side) * kPitch);
      btRigidBody* const ball = world->AddSphere(kRadius, {.mass = kMass, .pose = pose});
      ball->setLinearVelocity({kSpeed, 0, 0});
      ball->setAngularVelocity({0, 0, -kSpeed / kRadius});
    }
  }
};

}  // namespace

SceneInfo BallsScene() {
  return {.name = "balls",
          .description = "Balls that roll, each for itself",
          .size_means = "balls",
          .default_size = 1000,
          .min_size = 1,
          .max_size = 10000,
          .motion = SceneInfo::Motion::kKeepsMoving,
          .known_facts = BallsFacts,
          .make = MakeThat<Balls>};
}

}  // namespace cairn::bench
