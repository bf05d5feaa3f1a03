// SPDX-License-Identifier: MIT
#include <cmath>
#include <memory>

#include "scenes/scene.h"

namespace cairn::bench {
namespace {

constexpr btScalar kRadius = 2, kHalfHeight = btScalar(0.15);           // of the ring [m]
constexpr btScalar kLink = btScalar(0.8), kThickness = btScalar(0.03);  // [m]
constexpr btScalar kCeiling = 8;                                        // [m]
constexpr btScalar kRingMass = 1000, kLinkMass = 1;                     // [kg]
constexpr int kLinks = 4;                                               // of a rope

KnownFacts ChandelierFacts(int ropes) {
  return {.bodies = kLinks * ropes + 1,
          .joints = (kLinks + 1) * ropes,
          .top_height_m = kCeiling - kLink / 2,
          .mass_kg = double(kRingMass) + double(kLinkMass) * kLinks * ropes};
}

/// One body jointed to many: a disc that ropes around its rim hold, which would hold it alone, too.
class Chandelier : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    world->AddGround(20);
    const btScalar top = kCeiling - kLink * kLinks;
    btRigidBody* const ring = world->AddCylinder(
        kRadius, 2 * kHalfHeight, {.mass = kRingMass, .pose = At(0, top - kHalfHeight, 0)});
    for (int rope = 0; rope < size; ++rope) {
      const btScalar angle = SIMD_2_PI * btScalar(rope) / btScalar(size);
      const btVector3 at = kRadius * btVector3(std::cos(angle), 0, std::sin(angle));
      const btVector3 up(0, kLink / 2, 0);
      btRigidBody* above = nullptr;
      for (int i = 0; i < kLinks; ++i) {
        btRigidBody* const link = world->AddBox(
            btVector3(kThickness, kLink / 2, kThickness),
            {.mass = kLinkMass,
             .pose = At(at.x(), kCeiling - kLink * (btScalar(i) + btScalar(0.5)), at.z())});
        Pin(world, above == nullptr
                       ? std::make_unique<btPoint2PointConstraint>(*link, up)
                       : std::make_unique<btPoint2PointConstraint>(*link, *above, up, -up));
        above = link;
      }
      Pin(world, std::make_unique<btPoint2PointConstraint>(*ring, *above,
                                                           at + btVector3(0, kHalfHeight, 0), -up));
    }
    Watch(ring, btScalar(0.1));
  }

 private:
  static void Pin(World* world, std::unique_ptr<btTypedConstraint> pin) {
    world->AddJoint(std::move(pin), ConnectedBodies::kPassThrough);
  }
};

}  // namespace

SceneInfo ChandelierScene() {
  return {.name = "chandelier",
          .description = "A disc of 1000 kg on many ropes of links of 1 kg",
          .size_means = "ropes",
          .default_size = 12,
          .min_size = 3,
          .max_size = 60,
          .motion = SceneInfo::Motion::kComesToRest,
          .known_facts = ChandelierFacts,
          .make = MakeThat<Chandelier>};
}

}  // namespace cairn::bench
