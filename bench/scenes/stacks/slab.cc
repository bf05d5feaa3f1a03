// SPDX-License-Identifier: MIT
#include "scenes/scene.h"
#include "scenes/stacks/masonry.h"

namespace cairn::bench {
namespace {

constexpr Brick kColumn = {.length = btScalar(0.3), .height = 1, .depth = btScalar(0.3), .mass = 5};
constexpr btScalar kPitch = 1;                      // of columns [m]
constexpr btScalar kHalfThickness = btScalar(0.1);  // [m]
constexpr btScalar kSlabMass = 500;                 // [kg]

KnownFacts SlabFacts(int size) {
  return {.bodies = size * size + 1,
          .top_height_m = kColumn.height + kHalfThickness,
          .mass_kg = double(kColumn.mass) * size * size + kSlabMass};
}

class Slab : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    world->AddGround(kPitch * btScalar(size) + 20);
    const btScalar first = -btScalar(size - 1) / 2 * kPitch;
    for (int i = 0; i < size * size; ++i) {
      const btScalar x = first + btScalar(i % size) * kPitch,
                     z = first + btScalar(i / size) * kPitch;
      AddBrick(world, kColumn, At(x, kColumn.height / 2, z));
    }
    const btScalar half = kPitch * btScalar(size) / 2;
    Watch(world->AddBox(btVector3(half, kHalfThickness, half),
                        {.mass = kSlabMass, .pose = At(0, kColumn.height + kHalfThickness, 0)}),
          kColumn.height / 2);
  }
};

}  // namespace

SceneInfo SlabScene() {
  return {.name = "slab",
          .description = "A slab of 500 kg on columns of 5 kg",
          .size_means = "columns along a side",
          .default_size = 6,
          .min_size = 1,
          .max_size = 20,
          .motion = SceneInfo::Motion::kComesToRest,
          .known_facts = SlabFacts,
          .make = MakeThat<Slab>};
}

}  // namespace cairn::bench
