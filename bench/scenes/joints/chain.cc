// SPDX-License-Identifier: MIT
#include <cmath>

#include "scenes/facts.h"
#include "scenes/joints/hanging_chain.h"
#include "scenes/scene.h"

namespace cairn::bench {
namespace {

constexpr btScalar kLinkMass = 1, kBallMass = 10;  // [kg]
// Much more than 10 kg, and no accurate solver keeps the chain together at 60 Hz: links under
// tension T swing at sqrt(12 T / (m L)), which must stay below twice the frame rate.
constexpr double kSlope = 3.14159265358979 / 6;  // from the vertical, at the start [rad]

/// Of the anchor: the ball stays above y = 0 however the chain swings.
double AnchorHeight(int links) { return double(HangingChain::kLinkLength) * (links + 4); }

/// The chain hangs along -y of this frame.
btTransform ChainFrame(int links) {
  return btTransform(btQuaternion(btVector3(0, 0, 1), btScalar(kSlope)),
                     btVector3(0, btScalar(AnchorHeight(links)), 0));
}

KnownFacts ChainFacts(int links) {
  return {.bodies = links + 1,
          .joints = links + 1,
          .top_height_m = AnchorHeight(links) - HangingChain::kLinkLength / 2 * std::cos(kSlope),
          .mass_kg = double(kLinkMass) * links + kBallMass};
}

class Chain : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    AddHangingChain(world, {.links = size, .link_mass = kLinkMass, .ball_mass = kBallMass},
                    ChainFrame(size));
  }

  /// What the gaps add to the chain's length [m]: measured along the links, as they need not lie on
  /// a line.
  double HeightLost(const World& world) const override { return TotalJointGap(world); }
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
