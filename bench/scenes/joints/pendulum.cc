// SPDX-License-Identifier: MIT
#include "scenes/facts.h"
#include "scenes/joints/joint_frames.h"
#include "scenes/scene.h"

namespace cairn::bench {
namespace {

constexpr btScalar kLength = 1, kHalfThickness = btScalar(0.05);  // of a link [m]
constexpr btScalar kMass = 1;                                     // of a link [kg]

/// Of the first hinge: no link gets to the ground.
btScalar Height(int links) { return kLength * btScalar(links + 1); }

KnownFacts PendulumFacts(int links) {
  return {.bodies = links,
          .joints = links,
          .top_height_m = Height(links),
          .mass_kg = double(kMass) * links};
}

/// Lies along x at the start.
class Pendulum : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    const btScalar y = Height(size);
    btRigidBody* previous = world->AddBox(btVector3(kHalfThickness, kHalfThickness, kHalfThickness),
                                          {.pose = At(0, y, 0)});
    for (int i = 0; i < size; ++i) {
      btRigidBody* const link =
          world->AddBox(btVector3(kLength / 2, kHalfThickness, kHalfThickness),
                        {.mass = kMass, .pose = At(kLength * (btScalar(i) + btScalar(0.5)), y, 0)});
      // z of the world, as Bullet's hinges turn about z of their frames
      const btTransform frame = At(kLength * btScalar(i), y, 0);
      world->AddJoint(std::make_unique<btHingeConstraint>(*previous, *link, Local(*previous, frame),
                                                          Local(*link, frame)),
                      ConnectedBodies::kPassThrough);
      previous = link;
    }
  }

  /// What the gaps add to its length [m].
  double HeightLost(const World& world) const override { return TotalJointGap(world); }
};

}  // namespace

SceneInfo PendulumScene() {
  return {.name = "pendulum",
          .description = "Links on hinges swing down from the horizontal",
          .size_means = "links",
          .default_size = 5,
          .min_size = 1,
          .max_size = 50,
          .motion = SceneInfo::Motion::kKeepsMoving,
          .known_facts = PendulumFacts,
          .make = MakeThat<Pendulum>};
}

}  // namespace cairn::bench
