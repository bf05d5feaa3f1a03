// SPDX-License-Identifier: MIT
#include "scenes/joints/joint_frames.h"
#include "scenes/scene.h"

namespace cairn::bench {
namespace {

constexpr btScalar kHalfLength = 2, kHalfThickness = btScalar(0.05);      // of the plank [m]
constexpr btScalar kHalfDepth = btScalar(0.3);                            // [m]
constexpr btScalar kPivot = btScalar(0.6), kPost = btScalar(0.1);         // height, half width [m]
constexpr btScalar kHalfCrate = btScalar(0.2), kFromEnd = btScalar(0.3);  // [m]
constexpr btScalar kPlankMass = 20, kCrateMass = 10, kCounterMass = 5;    // [kg]
// on the plank crates must not slide, which tilts by 0.3: Bullet multiplies frictions
constexpr Surface kRough = {.friction = btScalar(0.8)};

btScalar HeightOfCrate(int crate) {
  return kPivot + kHalfThickness + kHalfCrate * btScalar(2 * crate + 1);
}

KnownFacts SeesawFacts(int crates) {
  return {.bodies = crates + 2,
          .joints = 1,
          .top_height_m = HeightOfCrate(crates - 1),
          .mass_kg = double(kCrateMass) * crates + kPlankMass + kCounterMass};
}

/// Along x, level at the start; crates at one end, and one of half the mass at the other.
class Seesaw : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    world->AddGround(20);
    btRigidBody* const post =
        world->AddBox(btVector3(kPost, kPivot / 4, kPost), {.pose = At(0, kPivot / 4, 0)});
    btRigidBody* const plank =
        world->AddBox(btVector3(kHalfLength, kHalfThickness, kHalfDepth),
                      {.mass = kPlankMass, .pose = At(0, kPivot, 0), .surface = kRough});
    // z of the world, as Bullet's hinges turn about z of their frames
    const btTransform frame = At(0, kPivot, 0);
    world->AddJoint(std::make_unique<btHingeConstraint>(*post, *plank, Local(*post, frame),
                                                        Local(*plank, frame)),
                    ConnectedBodies::kPassThrough);
    const btScalar x = kHalfLength - kFromEnd;
    AddCrate(world, kCounterMass, At(-x, HeightOfCrate(0), 0));
    for (int i = 0; i < size; ++i) AddCrate(world, kCrateMass, At(x, HeightOfCrate(i), 0));
  }

 private:
  static void AddCrate(World* world, btScalar mass, const btTransform& pose) {
    world->AddBox(btVector3(kHalfCrate, kHalfCrate, kHalfCrate),
                  {.mass = mass, .pose = pose, .surface = kRough});
  }
};

}  // namespace

SceneInfo SeesawScene() {
  return {.name = "seesaw",
          .description = "A seesaw tilts under crates at one end",
          .size_means = "crates at that end",
          .default_size = 1,
          .min_size = 1,
          .max_size = 20,
          .motion = SceneInfo::Motion::kComesToRest,
          .known_facts = SeesawFacts,
          .make = MakeThat<Seesaw>};
}

}  // namespace cairn::bench
