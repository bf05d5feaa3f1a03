// SPDX-License-Identifier: MIT
#include <cmath>
#include <vector>

#include "scenes/joints/joint_frames.h"
#include "scenes/scene.h"

// Light planks on two pins each, sagging from one end to the other, with heavy crates dropped on
// them. Each pair of pins holds six directions where five would do, and the bridge is built slack
// against no balance of forces: it swings into its place under load.
namespace cairn::bench {
namespace {

constexpr btScalar kPitch = btScalar(0.56);                                         // [m]
constexpr btScalar kSag = btScalar(1.0 / 7);                                        // per span
constexpr btScalar kPinSide = btScalar(0.7);                                        // [m]
constexpr btScalar kPlankMass = btScalar(0.8), kCrateMass = 20;                     // [kg]
constexpr btScalar kPlankHeight = btScalar(0.1), kCrateHalf = btScalar(0.4);        // [m]
constexpr btScalar kCrateSpacing = 1, kDrop = 1, kClearance = 6, kGroundHalf = 40;  // [m]
constexpr int kCrates = 5;

/// Of the bridge's middle line at x, a parabola that hangs from its two ends [m].
btScalar Height(int planks, btScalar x) {
  const btScalar span = kPitch * btScalar(planks), u = 2 * x / span;
  return kClearance + kSag * span * u * u;
}

btVector3 Joint(int planks, int i) {
  const btScalar x = kPitch * (btScalar(i) - btScalar(planks) / 2);
  return btVector3(x, Height(planks, x), 0);
}

btTransform PlankPose(int planks, int i) {
  const btVector3 a = Joint(planks, i), b = Joint(planks, i + 1), along = b - a;
  return btTransform(btQuaternion(btVector3(0, 0, 1), std::atan2(along.y(), along.x())),
                     (a + b) / 2);
}

btVector3 CratePosition(int planks, int crate) {
  const btScalar x = kCrateSpacing * (btScalar(crate) - btScalar(kCrates - 1) / 2);
  return btVector3(x, Height(planks, x) + kDrop + kPlankHeight / 2 + kCrateHalf, 0);
}

KnownFacts TwoPinBridgeFacts(int planks) {
  const double plank = PlankPose(planks, 1).getOrigin().y();
  const double crate = CratePosition(planks, 0).y();
  return {.bodies = planks - 2 + kCrates,
          .joints = 2 * (planks - 1),
          .top_height_m = plank > crate ? plank : crate,
          .mass_kg = 0.8 * (planks - 2) + double(kCrateMass) * kCrates};
}

class TwoPinBridge : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    world->AddGround(kGroundHalf);
    btRigidBody* previous = nullptr;
    for (int i = 0; i < size; ++i) {
      const bool is_end = i == 0 || i == size - 1;
      btRigidBody* const plank =
          world->AddBox(btVector3(kPitch, kPlankHeight, btScalar(1.6)) / 2,
                        {.mass = is_end ? 0 : kPlankMass, .pose = PlankPose(size, i)});
      if (previous != nullptr) AddPins(world, Joint(size, i), kPinSide, previous, plank);
      previous = plank;
    }
    const btVector3 half(kCrateHalf, kCrateHalf, kCrateHalf);
    for (int i = 0; i < kCrates; ++i) {
      const btVector3 at = CratePosition(size, i);
      world->AddBox(half, {.mass = kCrateMass, .pose = At(at.x(), at.y(), at.z())});
    }
  }
};

}  // namespace

SceneInfo TwoPinBridgeScene() {
  return {.name = "two-pin-bridge",
          .description = "Crates dropped on a sagging bridge of light planks on two pins each",
          .size_means = "planks",
          .default_size = 50,
          .min_size = 12,
          .max_size = 100,
          .motion = SceneInfo::Motion::kKeepsMoving,
          .known_facts = TwoPinBridgeFacts,
          .make = MakeThat<TwoPinBridge>};
}

}  // namespace cairn::bench
