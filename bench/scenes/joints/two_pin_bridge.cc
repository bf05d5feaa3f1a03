// SPDX-License-Identifier: MIT
#include <cmath>
#include <vector>

#include "scenes/joints/joint_frames.h"
#include "scenes/scene.h"

// Light planks on two pins each, sagging from one end to the other, with heavy crates dropped on
// them. Each pair of pins holds six directions where five would do, and the bridge is built slack
// against no balance of forces: it swings into its place under load. A second one has planks and
// crates that are heavier, and that lie on it from the start.
namespace cairn::bench {
namespace {

constexpr btScalar kPitch = btScalar(0.56);                                   // [m]
constexpr btScalar kSag = btScalar(1.0 / 7);                                  // per span
constexpr btScalar kPinSide = btScalar(0.7);                                  // [m]
constexpr btScalar kPlankHeight = btScalar(0.1), kCrateHalf = btScalar(0.4);  // [m]
constexpr btScalar kCrateSpacing = 1, kClearance = 6, kGroundHalf = 40;       // [m]
constexpr int kCrates = 5;

/// What a bridge is built of.
struct Masses {
  btScalar plank, crate;  ///< [kg]
  btScalar drop;          ///< Of the crates [m].
};
constexpr Masses kLight = {btScalar(0.8), 20, 1}, kHeavy = {12, 100, btScalar(0.06)};

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

btVector3 CratePosition(int planks, int crate, btScalar drop) {
  const btScalar x = kCrateSpacing * (btScalar(crate) - btScalar(kCrates - 1) / 2);
  return btVector3(x, Height(planks, x) + drop + kPlankHeight / 2 + kCrateHalf, 0);
}

KnownFacts FactsOf(const Masses& masses, int planks) {
  const double plank = PlankPose(planks, 1).getOrigin().y();
  const double crate = CratePosition(planks, 0, masses.drop).y();
  return {.bodies = planks - 2 + kCrates,
          .joints = 2 * (planks - 1),
          .top_height_m = plank > crate ? plank : crate,
          .mass_kg = double(masses.plank) * (planks - 2) + double(masses.crate) * kCrates};
}
KnownFacts TwoPinBridgeFacts(int planks) { return FactsOf(kLight, planks); }
KnownFacts CrateBridgeFacts(int planks) { return FactsOf(kHeavy, planks); }

class TwoPinBridge : public Scene {
 public:
  explicit TwoPinBridge(const SceneInfo& info, const Masses& masses = kLight)
      : Scene(info), masses_(masses) {}

 protected:
  void AddBodies(World* world, int size) override {
    world->AddGround(kGroundHalf);
    btRigidBody* previous = nullptr;
    for (int i = 0; i < size; ++i) {
      const bool is_end = i == 0 || i == size - 1;
      btRigidBody* const plank =
          world->AddBox(btVector3(kPitch, kPlankHeight, btScalar(1.6)) / 2,
                        {.mass = is_end ? 0 : masses_.plank, .pose = PlankPose(size, i)});
      if (previous != nullptr) AddPins(world, Joint(size, i), kPinSide, previous, plank);
      previous = plank;
    }
    const btVector3 half(kCrateHalf, kCrateHalf, kCrateHalf);
    for (int i = 0; i < kCrates; ++i) {
      const btVector3 at = CratePosition(size, i, masses_.drop);
      world->AddBox(half, {.mass = masses_.crate, .pose = At(at.x(), at.y(), at.z())});
    }
  }

 private:
  Masses masses_;
};

class CrateBridge : public TwoPinBridge {
 public:
  explicit CrateBridge(const SceneInfo& info) : TwoPinBridge(info, kHeavy) {}
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

SceneInfo CrateBridgeScene() {
  return {.name = "crate-bridge",
          .description = "Crates of 100 kg lie on a sagging bridge of planks of 12 kg",
          .size_means = "planks",
          .default_size = 40,
          .min_size = 12,
          .max_size = 100,
          .motion = SceneInfo::Motion::kKeepsMoving,
          .known_facts = CrateBridgeFacts,
          .make = MakeThat<CrateBridge>};
}

}  // namespace cairn::bench
