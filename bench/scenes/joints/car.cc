// SPDX-License-Identifier: MIT
#include "scenes/scene.h"

namespace cairn::bench {
namespace {

constexpr btScalar kHalfLength = btScalar(1.4), kHalfHeight = btScalar(0.25);  // of the body [m]
constexpr btScalar kHalfWidth = btScalar(0.65);                                // [m]
constexpr btScalar kRadius = btScalar(0.35), kTyre = btScalar(0.25);           // of a wheel [m]
constexpr btScalar kAxle = btScalar(1.1), kTrack = btScalar(0.85);  // wheels from the middle [m]
constexpr btScalar kHeight = btScalar(0.75);                        // of the body's middle [m]
constexpr btScalar kBodyMass = 800, kWheelMass = 20;                // [kg]
constexpr btScalar kTravel = btScalar(0.15);                        // of a spring [m]
constexpr btScalar kHertz = 2;                                      // of the car on its springs
constexpr btScalar kSpeed = 12, kTorque = 500;                      // of the motors [rad/s], [N m]
constexpr btScalar kBetweenCars = 4;                                // [m]
constexpr btScalar kBumpHeight = btScalar(0.1);                     // [m]
constexpr int kBumps = 12;

KnownFacts CarFacts(int cars) {
  return {.bodies = 5 * cars,
          .joints = 4 * cars,
          .top_height_m = kHeight,
          .mass_kg = double(kBodyMass + 4 * kWheelMass) * cars};
}

/// Along x, over bumps from side to side; two wheels steer a little, two drive.
class Car : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    const btScalar half_road = kBetweenCars * btScalar(size) / 2;
    world->AddGround(60 + half_road);
    for (int i = 0; i < kBumps; ++i) {
      world->AddBox(btVector3(kBumpHeight, kBumpHeight / 2, half_road),
                    {.pose = At(btScalar(4 + 2 * i), kBumpHeight / 2, 0)});
    }
    for (int i = 0; i < size; ++i) {
      AddCar(world, kBetweenCars * (btScalar(i) - btScalar(size - 1) / 2));
    }
  }

 private:
  static void AddCar(World* world, btScalar z) {
    btRigidBody* const body = world->AddBox(btVector3(kHalfLength, kHalfHeight, kHalfWidth),
                                            {.mass = kBodyMass, .pose = At(0, kHeight, z)});
    for (const btScalar side : {btScalar(-1), btScalar(1)}) {
      AddWheel(world, body, btVector3(kAxle, kRadius, z + side * kTrack));
      Drive(AddWheel(world, body, btVector3(-kAxle, kRadius, z + side * kTrack)));
    }
  }

  static btHinge2Constraint* AddWheel(World* world, btRigidBody* body, btVector3 middle) {
    const btTransform pose(btQuaternion(btVector3(1, 0, 0), SIMD_HALF_PI), middle);
    btRigidBody* const wheel =
        world->AddCylinder(kRadius, kTyre, {.mass = kWheelMass, .pose = pose, .surface = {1}});
    btVector3 up(0, 1, 0), axle(0, 0, 1);
    auto joint = std::make_unique<btHinge2Constraint>(*body, *wheel, middle, up, axle);
    btHinge2Constraint* const added = joint.get();
    joint->setLowerLimit(0);
    joint->setUpperLimit(0);
    joint->setLinearLowerLimit(btVector3(0, 0, -kTravel));
    joint->setLinearUpperLimit(btVector3(0, 0, kTravel));
    const btScalar omega = SIMD_2_PI * kHertz;
    joint->setStiffness(2, kBodyMass / 4 * omega * omega);
    joint->setDamping(2, kBodyMass / 4 * omega);
    world->AddJoint(std::move(joint), ConnectedBodies::kPassThrough);
    return added;
  }

  static void Drive(btHinge2Constraint* joint) {
    joint->enableMotor(3, true);
    joint->setTargetVelocity(3, kSpeed);
    joint->setMaxMotorForce(3, kTorque);
  }
};

}  // namespace

SceneInfo CarScene() {
  return {.name = "car",
          .description = "Cars on springs, with motors at two wheels, drive over bumps",
          .size_means = "cars",
          .default_size = 1,
          .min_size = 1,
          .max_size = 20,
          .motion = SceneInfo::Motion::kKeepsMoving,
          .known_facts = CarFacts,
          .make = MakeThat<Car>};
}

}  // namespace cairn::bench
