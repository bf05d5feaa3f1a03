// SPDX-License-Identifier: MIT
#include "scenes/scene.h"
#include "scenes/stacks/masonry.h"

namespace cairn::bench {
namespace {

constexpr Brick kBrick = {.length = 1, .height = btScalar(0.5), .depth = btScalar(0.5), .mass = 1};

KnownFacts WallFacts(int size) {
  return {.bodies = BricksInWall(size, size),
          .top_height_m = (size - 0.5) * kBrick.height,
          .mass_kg = double(kBrick.mass) * size * size};
}

class Wall : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    world->AddGround(btScalar(size) + 20);
    for (const btRigidBody* brick : AddWall(world, kBrick, Site(), size, size)) {
      Watch(brick, kBrick.height / 2);
    }
  }
};

}  // namespace

SceneInfo WallScene() {
  return {.name = "wall",
          .description = "Brick wall in running bond",
          .size_means = "courses, and bricks in a course",
          .default_size = 10,
          .min_size = 2,
          .max_size = 60,
          .motion = SceneInfo::Motion::kComesToRest,
          .known_facts = WallFacts,
          .make = MakeThat<Wall>};
}

}  // namespace cairn::bench
