// SPDX-License-Identifier: MIT
#include "scenes/scene.h"

namespace cairn::bench {
namespace {

constexpr btScalar kThickness = btScalar(0.08), kHeight = btScalar(0.6);  // [m]
constexpr btScalar kWidth = btScalar(0.3), kPitch = btScalar(0.3);        // [m]
constexpr btScalar kMass = 2;                                             // [kg]
constexpr btScalar kPush = btScalar(2.5);                                 // [rad/s]

KnownFacts DominoesFacts(int dominoes) {
  return {.bodies = dominoes, .top_height_m = kHeight / 2, .mass_kg = double(kMass) * dominoes};
}

/// A row along x, of which the first one turns about its foot.
class Dominoes : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    world->AddGround(kPitch * btScalar(size) / 2 + 10);
    const btVector3 half(kThickness / 2, kHeight / 2, kWidth / 2);
    for (int i = 0; i < size; ++i) {
      const btScalar x = kPitch * (btScalar(i) - btScalar(size - 1) / 2);
      world->AddBox(half, {.mass = kMass, .pose = At(x, kHeight / 2, 0)});
    }
    btRigidBody* const first = world->dynamic_bodies().front();
    first->setAngularVelocity(btVector3(0, 0, -kPush));
    first->setLinearVelocity(btVector3(kPush * kHeight / 2, 0, 0));
  }
};

}  // namespace

SceneInfo DominoesScene() {
  return {.name = "dominoes",
          .description = "A row of dominoes falls, one after the other",
          .size_means = "dominoes",
          .default_size = 100,
          .min_size = 1,
          .max_size = 1000,
          .motion = SceneInfo::Motion::kComesToRest,
          .known_facts = DominoesFacts,
          .make = MakeThat<Dominoes>};
}

}  // namespace cairn::bench
