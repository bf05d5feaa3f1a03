// SPDX-License-Identifier: MIT
#include <algorithm>

#include "scenes/joints/doll.h"
#include "scenes/scene.h"

namespace cairn::bench {
namespace {

constexpr int kSteps = 8;
constexpr btScalar kRise = btScalar(0.2), kTread = btScalar(0.3);  // [m]
constexpr btScalar kHalfWidth = 2, kLanding = 4;                   // [m]
constexpr btScalar kAboveTop = btScalar(0.5), kBetween = 1;        // of dolls, upwards [m]
constexpr btScalar kPush = btScalar(1.5);                          // down the stairs [m/s]

constexpr btScalar kTop = kRise * btScalar(kSteps);

/// Above the topmost steps, each above the one before and turned by a right angle.
btTransform PoseOf(int doll) {
  const btVector3 middle(kTread, kTop + kAboveTop + kBetween * btScalar(doll), 0);
  return LyingDoll(middle, doll, 0);
}

KnownFacts StairsFacts(int dolls) {
  double top = 0;
  for (int i = 0; i < dolls; ++i) top = std::max(top, DollTop(PoseOf(i)));
  return {.bodies = DollParts() * dolls,
          .joints = DollJoints() * dolls,
          .top_height_m = top,
          .mass_kg = DollMass() * dolls};
}

/// Down along x.
class Stairs : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    world->AddGround(40);
    AddStair(world, -kLanding, 0, kTop);
    for (int i = 0; i < kSteps; ++i) {
      AddStair(world, kTread * btScalar(i), kTread * btScalar(i + 1), kTop - kRise * btScalar(i));
    }
    for (int i = 0; i < size; ++i) AddDoll(world, PoseOf(i));
    for (btRigidBody* part : world->dynamic_bodies()) {
      part->setLinearVelocity(btVector3(kPush, 0, 0));
    }
  }

 private:
  static void AddStair(World* world, btScalar from, btScalar to, btScalar height) {
    world->AddBox(btVector3((to - from) / 2, height / 2, kHalfWidth),
                  {.pose = At((from + to) / 2, height / 2, 0)});
  }
};

}  // namespace

SceneInfo StairsScene() {
  return {.name = "stairs",
          .description = "Ragdolls tumble down a flight of stairs",
          .size_means = "ragdolls",
          .default_size = 1,
          .min_size = 1,
          .max_size = 20,
          .motion = SceneInfo::Motion::kComesToRest,
          .known_facts = StairsFacts,
          .make = MakeThat<Stairs>};
}

}  // namespace cairn::bench
