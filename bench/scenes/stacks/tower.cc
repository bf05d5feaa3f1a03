// SPDX-License-Identifier: MIT
#include "scenes/scene.h"
#include "scenes/stacks/masonry.h"

namespace cairn::bench {
namespace {

constexpr Brick kBox = {.length = 1, .height = 1, .depth = 1, .mass = 1};

KnownFacts TowerFacts(int size) {
  return {.bodies = size,
          .top_height_m = (size - 0.5) * kBox.height,
          .mass_kg = double(kBox.mass) * size};
}

class Tower : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    world->AddGround(btScalar(size) + 20);
    Watch(AddStack(world, kBox, Site(), size).back(), kBox.height / 2);
  }
};

}  // namespace

SceneInfo TowerScene() {
  return {.name = "tower",
          .description = "One stack of equal boxes",
          .size_means = "boxes",
          .default_size = 30,
          .min_size = 1,
          .max_size = 100,
          .motion = SceneInfo::Motion::kComesToRest,
          .known_facts = TowerFacts,
          .make = MakeThat<Tower>};
}

}  // namespace cairn::bench
