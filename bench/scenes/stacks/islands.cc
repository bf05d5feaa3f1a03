// SPDX-License-Identifier: MIT
#include "scenes/scene.h"
#include "scenes/stacks/masonry.h"
#include "scenes/stacks/square.h"

namespace cairn::bench {
namespace {

constexpr Brick kBox = {.length = 1, .height = 1, .depth = 1, .mass = 1};
constexpr int kBoxesPerStack = 5;
constexpr btScalar kPitch = 3;  // [m]

KnownFacts IslandsFacts(int size) {
  return {.bodies = kBoxesPerStack * size,
          .top_height_m = (kBoxesPerStack - 0.5) * kBox.height,
          .mass_kg = double(kBox.mass) * kBoxesPerStack * size};
}

class Islands : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    const int side = PlacesPerSide(size);
    const btScalar first = -btScalar(side - 1) / 2 * kPitch;
    world->AddGround(kPitch * btScalar(side) / 2 + 10);
    for (int i = 0; i < size; ++i) {
      const Site site =
          Site().Moved(first + btScalar(i % side) * kPitch, 0, first + btScalar(i / side) * kPitch);
      Watch(AddStack(world, kBox, site, kBoxesPerStack).back(), kBox.height / 2);
    }
  }
};

}  // namespace

SceneInfo IslandsScene() {
  return {.name = "islands",
          .description = "Many small stacks that do not touch each other",
          .size_means = "stacks of five boxes",
          .default_size = 300,
          .min_size = 1,
          .max_size = 4000,
          .motion = SceneInfo::Motion::kComesToRest,
          .known_facts = IslandsFacts,
          .make = MakeThat<Islands>};
}

}  // namespace cairn::bench
