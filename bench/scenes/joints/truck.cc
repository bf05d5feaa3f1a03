// SPDX-License-Identifier: MIT
#include <memory>

#include "scenes/joints/joint_frames.h"
#include "scenes/scene.h"

namespace cairn::bench {
namespace {

constexpr btScalar kPitch = btScalar(0.5), kPlankGap = btScalar(0.04);            // [m]
constexpr btScalar kPlankHalfHeight = btScalar(0.1), kHalfWidth = btScalar(1.8);  // [m]
constexpr btScalar kPinSide = btScalar(1.6), kDeck = 6;                           // [m]
constexpr btScalar kBankHalf = 6;                                                 // of a bank [m]
constexpr btScalar kBodyHalf = btScalar(2.2), kRadius = btScalar(0.5);            // [m]
constexpr btScalar kTyre = btScalar(0.4), kAxle = btScalar(1.6), kTrack = 1;      // [m]
constexpr btScalar kPlankMass = 40, kBodyMass = 4000, kWheelMass = 100;           // [kg]
constexpr btScalar kSpeed = 6, kTorque = 3000;                                    // [rad/s], [N m]

KnownFacts TruckFacts(int planks) {
  return {.bodies = planks + 5,
          .joints = 2 * (planks + 1) + 4,
          .top_height_m = kDeck + 2 * kRadius,
          .mass_kg = double(kPlankMass) * planks + double(kBodyMass + 4 * kWheelMass)};
}

/// From one bank to the other along x, over planks on two pins each.
class Truck : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    world->AddGround(40);
    const btScalar half_span = kPitch * btScalar(size) / 2;
    const btScalar bank_x = half_span + kBankHalf + kPlankGap;
    btRigidBody* previous = AddBank(world, -bank_x);
    for (int i = 0; i < size; ++i) {
      const btScalar x = kPitch * (btScalar(i) + btScalar(0.5)) - half_span;
      btRigidBody* const plank = world->AddBox(
          btVector3((kPitch - kPlankGap) / 2, kPlankHalfHeight, kHalfWidth),
          {.mass = kPlankMass, .pose = At(x, kDeck - kPlankHalfHeight, 0), .surface = {1}});
      AddPins(world, btVector3(x - kPitch / 2, kDeck - kPlankHalfHeight, 0), kPinSide, previous,
              plank);
      previous = plank;
    }
    AddPins(world, btVector3(half_span, kDeck - kPlankHalfHeight, 0), kPinSide, previous,
            AddBank(world, bank_x));
    AddVehicle(world, -half_span - kBankHalf);
  }

 private:
  static btRigidBody* AddBank(World* world, btScalar x) {
    return world->AddBox(btVector3(kBankHalf, kDeck / 2, kHalfWidth),
                         {.pose = At(x, kDeck / 2, 0), .surface = {1}});
  }

  static void AddVehicle(World* world, btScalar x) {
    const btScalar axle = kDeck + kRadius;
    btRigidBody* const body = world->AddBox(btVector3(kBodyHalf, btScalar(0.3), btScalar(0.7)),
                                            {.mass = kBodyMass, .pose = At(x, axle + kRadius, 0)});
    for (const btScalar way : {btScalar(-1), btScalar(1)}) {
      for (const btScalar side : {btScalar(-1), btScalar(1)}) {
        const btVector3 at(x + way * kAxle, axle, side * kTrack);
        const btTransform pose(btQuaternion(btVector3(1, 0, 0), SIMD_HALF_PI), at);
        btRigidBody* const wheel =
            world->AddCylinder(kRadius, kTyre, {.mass = kWheelMass, .pose = pose, .surface = {1}});
        const btTransform frame = FrameAlongZ(at, btVector3(0, 0, 1));
        auto hinge = std::make_unique<btHingeConstraint>(*body, *wheel, Local(*body, frame),
                                                         Local(*wheel, frame));
        hinge->enableAngularMotor(true, kSpeed, kTorque * world->time_step());
        world->AddJoint(std::move(hinge), ConnectedBodies::kPassThrough);
      }
    }
  }
};

}  // namespace

SceneInfo TruckScene() {
  return {.name = "truck",
          .description = "A truck of 4400 kg drives over a bridge of planks of 40 kg",
          .size_means = "planks",
          .default_size = 24,
          .min_size = 4,
          .max_size = 60,
          .motion = SceneInfo::Motion::kKeepsMoving,
          .known_facts = TruckFacts,
          .make = MakeThat<Truck>};
}

}  // namespace cairn::bench
