// SPDX-License-Identifier: MIT
#include <cmath>

#include "scenes/facts.h"
#include "scenes/scene.h"

namespace cairn::bench {
namespace {

constexpr btScalar kLinkLength = 1, kLinkThickness = btScalar(0.2);  // [m]
constexpr btScalar kLinkMass = 1, kBallMass = 10;                    // [kg]
constexpr btScalar kBallRadius = btScalar(0.5);                      // [m]
// Much more than 10 kg, and no accurate solver keeps the chain together at 60 Hz: links under
// tension T swing at sqrt(12 T / (m L)), which must stay below twice the frame rate.
constexpr double kSlope = 3.14159265358979 / 6;  // from the vertical, at the start [rad]

/// Of the anchor: the ball stays above y = 0 however the chain swings.
double AnchorHeight(int links) { return double(kLinkLength) * (links + 4); }

/// The chain hangs along -y of this frame.
btTransform ChainFrame(int links) {
  return btTransform(btQuaternion(btVector3(0, 0, 1), btScalar(kSlope)),
                     btVector3(0, btScalar(AnchorHeight(links)), 0));
}

KnownFacts ChainFacts(int links) {
  return {.bodies = links + 1,
          .joints = links + 1,
          .top_height_m = AnchorHeight(links) - kLinkLength / 2 * std::cos(kSlope),
          .mass_kg = double(kLinkMass) * links + kBallMass};
}

class Chain : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    const btTransform frame = ChainFrame(size);
    const btVector3 half(kLinkThickness / 2, kLinkLength / 2, kLinkThickness / 2);
    const btVector3 top(0, kLinkLength / 2, 0), ball_top(0, kBallRadius, 0);
    btRigidBody* previous = nullptr;
    for (int i = 0; i < size; ++i) {
      const btScalar y = -(btScalar(i) + btScalar(0.5)) * kLinkLength;
      btRigidBody* link = world->AddBox(half, {.mass = kLinkMass, .pose = frame * At(0, y, 0)});
      Pin(world, link, top, previous);
      previous = link;
    }
    const btScalar y = -btScalar(size) * kLinkLength - kBallRadius;
    Pin(world, world->AddSphere(kBallRadius, {.mass = kBallMass, .pose = frame * At(0, y, 0)}),
        ball_top, previous);
  }

  /// What the gaps add to the chain's length [m]: measured along the links, as they need not lie on
  /// a line.
  double HeightLost(const World& world) const override { return TotalJointGap(world); }

 private:
  /// Hangs a body by `pivot` on the lower end of a link, or on the world if there is none.
  static void Pin(World* world, btRigidBody* body, const btVector3& pivot, btRigidBody* link) {
    auto pin = link == nullptr ? std::make_unique<btPoint2PointConstraint>(*body, pivot)
                               : std::make_unique<btPoint2PointConstraint>(
                                     *body, *link, pivot, btVector3(0, -kLinkLength / 2, 0));
    world->AddJoint(std::move(pin), ConnectedBodies::kPassThrough);
  }
};

}  // namespace

SceneInfo ChainScene() {
  return {.name = "chain",
          .description = "A chain of 1 kg links with a 10 kg ball at its end swings",
          .size_means = "links",
          .default_size = 20,
          .min_size = 1,
          .max_size = 100,
          .motion = SceneInfo::Motion::kKeepsMoving,
          .known_facts = ChainFacts,
          .make = MakeThat<Chain>};
}

}  // namespace cairn::bench
