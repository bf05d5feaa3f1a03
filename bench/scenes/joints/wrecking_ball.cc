// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "scenes/joints/hanging_chain.h"
#include "scenes/scene.h"
#include "scenes/stacks/masonry.h"

namespace cairn::bench {
namespace {

constexpr Brick kBrick = {.length = 1, .height = btScalar(0.5), .depth = btScalar(0.5), .mass = 10};
constexpr int kBricks = 5, kCourses = 6;
constexpr btScalar kLinkMass = 5, kBallMass = 50;  // [kg]
constexpr double kSwing = 3.14159265358979 / 3;    // from the vertical, at the start [rad]
constexpr double kLowest = 1.25;                   // of the ball's centre [m]

double AnchorHeight(int links) {
  return kLowest + double(HangingChain::kBallRadius) + double(HangingChain::kLinkLength) * links;
}

KnownFacts WreckingBallFacts(int links) {
  const double link = AnchorHeight(links) - HangingChain::kLinkLength / 2 * std::cos(kSwing);
  return {.bodies = BricksInWall(kBricks, kCourses) + links + 1,
          .joints = links + 1,
          .top_height_m = std::max(link, (kCourses - 0.5) * double(kBrick.height)),
          .mass_kg = double(kBrick.mass) * kBricks * kCourses + double(kLinkMass) * links +
                     double(kBallMass)};
}

/// The wall stands along x; the ball swings along z, and would hang before the wall's face.
class WreckingBall : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    world->AddGround(30);
    AddWall(world, kBrick, Site(), kBricks, kCourses);
    const btVector3 anchor(0, btScalar(AnchorHeight(size)),
                           kBrick.depth / 2 + HangingChain::kBallRadius);
    const btQuaternion swung(btVector3(1, 0, 0), btScalar(-kSwing));
    AddHangingChain(world, {.links = size, .link_mass = kLinkMass, .ball_mass = kBallMass},
                    btTransform(swung, anchor));
  }
};

}  // namespace

SceneInfo WreckingBallScene() {
  return {.name = "wrecking-ball",
          .description = "A ball on a chain swings into a wall",
          .size_means = "links",
          .default_size = 6,
          .min_size = 1,
          .max_size = 30,
          .motion = SceneInfo::Motion::kKeepsMoving,
          .known_facts = WreckingBallFacts,
          .make = MakeThat<WreckingBall>};
}

}  // namespace cairn::bench
