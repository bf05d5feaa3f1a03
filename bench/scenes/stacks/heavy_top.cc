// SPDX-License-Identifier: MIT
#include "scenes/scene.h"
#include "scenes/stacks/masonry.h"

namespace cairn::bench {
namespace {

constexpr Brick kLight = {.length = 1, .height = 1, .depth = 1, .mass = 1};
constexpr Brick kHeavy = {.length = 1, .height = 1, .depth = 1, .mass = 100};

KnownFacts HeavyTopFacts(int size) {
  return {.bodies = size + 1,
          .top_height_m = size * kLight.height + 0.5 * kHeavy.height,
          .mass_kg = double(kLight.mass) * size + kHeavy.mass};
}

class HeavyTop : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    world->AddGround(btScalar(size) + 20);
    AddStack(world, kLight, Site(), size);
    const Site on_top = Site().Moved(0, btScalar(size) * kLight.height, 0);
    Watch(AddStack(world, kHeavy, on_top, 1).back(), kHeavy.height / 2);
  }
};

}  // namespace

SceneInfo HeavyTopScene() {
  return {.name = "heavy-top",
          .description = "A stack of 1 kg boxes with one of 100 kg on top",
          .size_means = "light boxes",
          .default_size = 15,
          .min_size = 1,
          .max_size = 50,
          .motion = SceneInfo::Motion::kComesToRest,
          .known_facts = HeavyTopFacts,
          .make = MakeThat<HeavyTop>};
}

}  // namespace cairn::bench
