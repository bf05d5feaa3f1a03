// SPDX-License-Identifier: MIT
#include <algorithm>

#include "scenes/joints/doll.h"
#include "scenes/random.h"
#include "scenes/scene.h"

namespace cairn::bench {
namespace {

constexpr std::uint64_t kSeed = 11;
constexpr int kDollsPerLayer = 4;
constexpr btScalar kCell = 2;       // per doll [m]
constexpr btScalar kPitHeight = 1;  // [m]
constexpr btScalar kLayer = 1;      // [m]
constexpr double kTilt = 0.2;       // at most, from the horizontal [rad]

/// Where a doll lies: on its back, turned to one of four sides and a little tilted.
btTransform LyingPose(int doll, Random* random) {
  const btScalar tilt = btScalar(random->Within(-kTilt, kTilt));
  const int right_angles = static_cast<int>(random->Bits() % 4);
  const int cell = doll % kDollsPerLayer, layer = doll / kDollsPerLayer;
  const btVector3 centre(kCell * (btScalar(cell % 2) - btScalar(0.5)),
                         kLayer * (btScalar(layer) + btScalar(0.6)),
                         kCell * (btScalar(cell / 2) - btScalar(0.5)));
  return LyingDoll(centre, right_angles, tilt);
}

KnownFacts RagdollsFacts(int dolls) {
  double top = 0;
  Random random(kSeed);
  for (int i = 0; i < dolls; ++i) top = std::max(top, DollTop(LyingPose(i, &random)));
  return {.bodies = DollParts() * dolls,
          .joints = DollJoints() * dolls,
          .top_height_m = top,
          .mass_kg = DollMass() * dolls};
}

class Ragdolls : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    world->AddPit(kCell + btScalar(0.1), kPitHeight);
    Random random(kSeed);
    for (int i = 0; i < size; ++i) AddDoll(world, LyingPose(i, &random));
  }
};

}  // namespace

SceneInfo RagdollsScene() {
  return {.name = "ragdolls",
          .description = "Ragdolls of capsules, hinges and cone-twist joints dropped in a pile",
          .size_means = "ragdolls",
          .default_size = 20,
          .min_size = 1,
          .max_size = 400,
          .motion = SceneInfo::Motion::kComesToRest,
          .known_facts = RagdollsFacts,
          .make = MakeThat<Ragdolls>};
}

}  // namespace cairn::bench
