// SPDX-License-Identifier: MIT
#include <memory>

#include "scenes/joints/joint_frames.h"
#include "scenes/scene.h"

namespace cairn::bench {
namespace {

constexpr btScalar kHeight = 20, kReach = 10, kHalfJib = btScalar(0.3);  // [m]
constexpr btScalar kLink = btScalar(0.6), kThickness = btScalar(0.08);   // [m]
constexpr btScalar kHook = btScalar(0.25), kHalfLoad = 1;                // half sides [m]
constexpr btScalar kJibMass = 800, kLinkMass = 3, kHookMass = 20, kLoadMass = 2000;  // [kg]
constexpr btScalar kSpeed = btScalar(0.2), kTorque = btScalar(2e5);  // [rad/s], [N m]

KnownFacts CraneFacts(int links) {
  return {.bodies = links + 3,
          .joints = links + 3,
          .top_height_m = kHeight,
          .mass_kg = double(kJibMass + kHookMass + kLoadMass) + double(kLinkMass) * links};
}

/// The jib turns about the mast by a motor; from its tip hang the rope, the hook and the load.
class Crane : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    world->AddGround(40);
    btRigidBody* const mast =
        world->AddBox(btVector3(kHalfJib, kHeight / 2, kHalfJib), {.pose = At(0, kHeight / 2, 0)});
    btRigidBody* const jib = world->AddBox(btVector3(kReach / 2, kHalfJib, kHalfJib),
                                           {.mass = kJibMass, .pose = At(kReach / 2, kHeight, 0)});
    const btTransform frame = FrameAlongZ(btVector3(0, kHeight, 0), btVector3(0, 1, 0));
    auto turn =
        std::make_unique<btHingeConstraint>(*mast, *jib, Local(*mast, frame), Local(*jib, frame));
    turn->enableAngularMotor(true, kSpeed, kTorque * world->time_step());
    world->AddJoint(std::move(turn), ConnectedBodies::kPassThrough);
    btScalar y = kHeight - kHalfJib;
    btRigidBody* above = jib;
    const auto hang = [&](btScalar half, const btVector3& extents, btScalar mass) {
      btRigidBody* const body =
          world->AddBox(extents, {.mass = mass, .pose = At(kReach, y - half, 0)});
      const btTransform at = At(kReach, y, 0);
      world->AddJoint(
          std::make_unique<btPoint2PointConstraint>(*body, *above, Local(*body, at).getOrigin(),
                                                    Local(*above, at).getOrigin()),
          ConnectedBodies::kPassThrough);
      y -= 2 * half;
      above = body;
    };
    for (int i = 0; i < size; ++i) {
      hang(kLink / 2, btVector3(kThickness, kLink / 2, kThickness), kLinkMass);
    }
    hang(kHook, btVector3(kHook, kHook, kThickness), kHookMass);
    hang(kHalfLoad, btVector3(kHalfLoad, kHalfLoad, kHalfLoad), kLoadMass);
  }
};

}  // namespace

SceneInfo CraneScene() {
  return {.name = "crane",
          .description = "A crane turns with 2000 kg on the hook of its rope",
          .size_means = "links of the rope",
          .default_size = 20,
          .min_size = 1,
          .max_size = 25,
          .motion = SceneInfo::Motion::kKeepsMoving,
          .known_facts = CraneFacts,
          .make = MakeThat<Crane>};
}

}  // namespace cairn::bench
