// SPDX-License-Identifier: MIT
#include "scenes/scene.h"
#include "scenes/stacks/masonry.h"

namespace cairn::bench {
namespace {

constexpr Brick kBox = {.length = 1, .height = 1, .depth = 1, .mass = 1};
constexpr btScalar kPitch = btScalar(1.1);  // [m], so that neighbours do not touch

KnownFacts Pyramid3dFacts(int size) {
  const int boxes = size * (size + 1) * (2 * size + 1) / 6;
  return {.bodies = boxes,
          .top_height_m = (size - 0.5) * kBox.height,
          .mass_kg = double(kBox.mass) * boxes};
}

class Pyramid3d : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    world->AddGround(btScalar(size) + 20);
    for (int layer = 0; layer < size; ++layer) AddLayer(world, layer, size - layer);
    Watch(world->dynamic_bodies().back(), kBox.height / 2);
  }

 private:
  static void AddLayer(World* world, int layer, int side) {
    const btScalar first = -btScalar(side - 1) / 2 * kPitch;
    const btScalar y = (btScalar(layer) + btScalar(0.5)) * kBox.height;
    for (int i = 0; i < side; ++i) {
      for (int k = 0; k < side; ++k) {
        AddBrick(world, kBox, At(first + btScalar(i) * kPitch, y, first + btScalar(k) * kPitch));
      }
    }
  }
};

}  // namespace

SceneInfo Pyramid3dScene() {
  return {.name = "pyramid3d",
          .description = "Pyramid of square layers of boxes",
          .size_means = "boxes along a side of the base",
          .default_size = 10,
          .min_size = 1,
          .max_size = 30,
          .motion = SceneInfo::Motion::kComesToRest,
          .known_facts = Pyramid3dFacts,
          .make = MakeThat<Pyramid3d>};
}

}  // namespace cairn::bench
