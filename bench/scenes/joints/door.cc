// SPDX-License-Identifier: MIT
#include "scenes/joints/joint_frames.h"
#include "scenes/scene.h"

namespace cairn::bench {
namespace {

constexpr btScalar kHalfWidth = btScalar(0.45), kHalfHeight = 1;   // of a leaf [m]
constexpr btScalar kHalfThickness = btScalar(0.05);                // [m]
constexpr btScalar kSill = btScalar(0.02), kJamb = btScalar(0.1);  // gap beneath, post [m]
constexpr btScalar kLeafMass = 30, kCrateMass = 10;                // [kg]
constexpr btScalar kHalfCrate = btScalar(0.2);                     // [m]
constexpr btScalar kOpen = btScalar(1.4);                          // at most [rad]
constexpr btScalar kSpeed = btScalar(1.5), kImpulse = 2;           // [rad/s], [N m s]
constexpr btScalar kPitch = 3;                                     // of doors [m]
constexpr int kTurnEvery = 90;                                     // [frames]

KnownFacts DoorFacts(int doors) {
  return {.bodies = 2 * doors,
          .joints = doors,
          .top_height_m = kSill + kHalfHeight,
          .mass_kg = double(kLeafMass + kCrateMass) * doors};
}

/// Leaves lie in the xy plane and open towards z, where a crate stands in their way.
class Door : public Scene {
 public:
  using Scene::Scene;

  void BeforeStep(World*, int frame) override {
    if (frame % kTurnEvery != 0) return;
    const btScalar speed = frame / kTurnEvery % 2 == 0 ? kSpeed : -kSpeed;
    for (btHingeConstraint* hinge : hinges_) hinge->enableAngularMotor(true, speed, kImpulse);
  }

 protected:
  void AddBodies(World* world, int size) override {
    world->AddGround(kPitch * btScalar(size) + 10);
    for (int i = 0; i < size; ++i) {
      AddDoor(world, kPitch * (btScalar(i) - btScalar(size - 1) / 2));
    }
  }

 private:
  void AddDoor(World* world, btScalar x) {
    const btScalar y = kSill + kHalfHeight;
    btRigidBody* const post =
        world->AddBox(btVector3(kJamb, y, kJamb), {.pose = At(x - kHalfWidth - kJamb, y, 0)});
    btRigidBody* const leaf = world->AddBox(btVector3(kHalfWidth, kHalfHeight, kHalfThickness),
                                            {.mass = kLeafMass, .pose = At(x, y, 0)});
    const btTransform frame = FrameAlongZ(btVector3(x - kHalfWidth, y, 0), btVector3(0, 1, 0));
    auto hinge =
        std::make_unique<btHingeConstraint>(*post, *leaf, Local(*post, frame), Local(*leaf, frame));
    hinge->setLimit(0, kOpen);
    hinges_.push_back(hinge.get());
    world->AddJoint(std::move(hinge), ConnectedBodies::kPassThrough);
    world->AddBox(btVector3(kHalfCrate, kHalfCrate, kHalfCrate),
                  {.mass = kCrateMass, .pose = At(x + kHalfWidth / 2, kHalfCrate, kHalfWidth)});
  }

  std::vector<btHingeConstraint*> hinges_;
};

}  // namespace

SceneInfo DoorScene() {
  return {.name = "door",
          .description = "Doors with motors open and close between their limits, and push crates",
          .size_means = "doors",
          .default_size = 1,
          .min_size = 1,
          .max_size = 50,
          .motion = SceneInfo::Motion::kKeepsMoving,
          .known_facts = DoorFacts,
          .make = MakeThat<Door>};
}

}  // namespace cairn::bench
