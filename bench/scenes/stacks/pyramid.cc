// SPDX-License-Identifier: MIT
#include "scenes/scene.h"
#include "scenes/stacks/masonry.h"

namespace cairn::bench {
namespace {

constexpr Brick kBox = {.length = 1, .height = 1, .depth = 1, .mass = 1};
constexpr btScalar kPitch = btScalar(1.1);  // [m], so that neighbours do not touch

KnownFacts PyramidFacts(int size) {
  const int boxes = size * (size + 1) / 2;
  return {.bodies = boxes,
          .top_height_m = (size - 0.5) * kBox.height,
          .mass_kg = double(kBox.mass) * boxes};
}

class Pyramid : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    world->AddGround(btScalar(size) + 20);
    btRigidBody* top = nullptr;
    for (int row = 0; row < size; ++row) {
      const int boxes = size - row;
      for (int i = 0; i < boxes; ++i) {
        const btScalar x = (btScalar(i) - btScalar(boxes - 1) / 2) * kPitch;
        top = AddBrick(world, kBox, At(x, (btScalar(row) + btScalar(0.5)) * kBox.height, 0));
      }
    }
    Watch(top, kBox.height / 2);
  }
};

}  // namespace

SceneInfo PyramidScene() {
  return {.name = "pyramid",
          .description = "Flat pyramid of boxes, one box thick",
          .size_means = "boxes in the base row",
          .default_size = 20,
          .min_size = 1,
          .max_size = 200,
          .motion = SceneInfo::Motion::kComesToRest,
          .known_facts = PyramidFacts,
          .make = MakeThat<Pyramid>};
}

}  // namespace cairn::bench
