// SPDX-License-Identifier: MIT
#include <cmath>

#include "scenes/scene.h"
#include "scenes/stacks/masonry.h"

namespace cairn::bench {
namespace {

constexpr Brick kLightest = {.length = 1, .height = 1, .depth = 1, .mass = 1};
constexpr double kDoublings = 6;  // of the mass, from the lowest box to the topmost

double MassOf(int box, int boxes) {
  // not pow(64, ...), which clang computes as this and GCC does not
  return kLightest.mass * std::exp2(kDoublings * box / (boxes - 1));
}

KnownFacts GrowingTowerFacts(int size) {
  double mass = 0;
  for (int i = 0; i < size; ++i) mass += MassOf(i, size);
  return {.bodies = size, .top_height_m = (size - 0.5) * kLightest.height, .mass_kg = mass};
}

class GrowingTower : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    world->AddGround(btScalar(size) + 20);
    for (int i = 0; i < size; ++i) {
      Brick box = kLightest;
      box.mass = btScalar(MassOf(i, size));
      AddStack(world, box, Site().Moved(0, btScalar(i) * box.height, 0), 1);
    }
    Watch(world->dynamic_bodies().back(), kLightest.height / 2);
  }
};

}  // namespace

SceneInfo GrowingTowerScene() {
  return {.name = "growing-tower",
          .description = "A stack of boxes whose masses grow upwards, 64 times in all",
          .size_means = "boxes",
          .default_size = 7,
          .min_size = 2,
          .max_size = 50,
          .motion = SceneInfo::Motion::kComesToRest,
          .known_facts = GrowingTowerFacts,
          .make = MakeThat<GrowingTower>};
}

}  // namespace cairn::bench
