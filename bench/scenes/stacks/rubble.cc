// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/random.h"
#include "scenes/scene.h"

namespace cairn::bench {
namespace {

constexpr std::uint64_t kSeed = 20080501;
constexpr btScalar kCell = 1;           // of the grid in which pieces start [m]
constexpr btScalar kPitHeight = 4;      // [m]
constexpr double kCellsPerSide = 0.95;  // times the cube root of the number of pieces
constexpr btScalar kPieceMass = 1;      // [kg]
constexpr int kSizes = 3, kHulls = 4, kCorners = 12, kKinds = 5;
constexpr double kPi = 3.14159265358979;

/// Round pieces would roll for ever without it; these values add rolling rows to their contacts.
constexpr Surface kRound = {.friction = btScalar(0.5),
                            .rolling_friction = btScalar(0.05),
                            .spinning_friction = btScalar(0.05)};

using Hull = std::array<btVector3, kCorners>;

/// As wide as high: the pit grows with the pile.
int CellsPerSide(int pieces) {
  return std::max(2, static_cast<int>(std::lround(kCellsPerSide * std::cbrt(pieces))));
}

/// Height of the centre of a layer's cells [m].
double LayerHeight(int layer) { return (layer + 0.75) * kCell; }

KnownFacts RubbleFacts(int pieces) {
  const int side = CellsPerSide(pieces);
  return {.bodies = pieces,
          .top_height_m = LayerHeight((pieces - 1) / (side * side)),
          .mass_kg = double(kPieceMass) * pieces};
}

btQuaternion RandomTurn(Random* random) {
  const btVector3 axis = random->InCube(1) + btVector3(0, btScalar(1e-3), 0);
  return btQuaternion(axis.normalized(), btScalar(random->Within(0, 2 * kPi)));
}

/// Corners on an ellipsoid of about `radius` [m], with their mean at the origin.
Hull RandomHull(Random* random, double radius) {
  Hull hull;
  btVector3 mean(0, 0, 0);
  for (btVector3& corner : hull) {
    const btVector3 direction = random->InCube(1) + btVector3(0, btScalar(1e-3), 0);
    corner = direction.normalized() * btVector3(1, btScalar(0.8), btScalar(0.7)) * btScalar(radius);
    mean += corner / btScalar(kCorners);
  }
  for (btVector3& corner : hull) corner -= mean;
  return hull;
}

class Rubble : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    Random random(kSeed);
    std::array<Hull, kHulls> hulls;
    for (Hull& hull : hulls) hull = RandomHull(&random, random.Within(0.25, 0.4));

    const int side = CellsPerSide(size);
    world->AddPit(btScalar(side) * kCell / 2, kPitHeight);
    for (int i = 0; i < size; ++i) {
      const btScalar x = (btScalar(i % side) - btScalar(side - 1) / 2) * kCell;
      const btScalar z = (btScalar(i / side % side) - btScalar(side - 1) / 2) * kCell;
      const btVector3 centre(x, btScalar(LayerHeight(i / (side * side))), z);
      const btTransform pose(RandomTurn(&random), centre);
      const int scale = static_cast<int>(random.Bits() % kSizes);
      AddPiece(world, i % kKinds, btScalar(scale), hulls[random.Bits() % kHulls], pose);
    }
  }

 private:
  /// Pieces are 0.4 to 0.9 m across, whatever their kind. `scale` is 0 to kSizes - 1.
  static void AddPiece(World* world, int kind, btScalar scale, const Hull& hull,
                       const btTransform& pose) {
    const btScalar r = btScalar(0.2) + btScalar(0.05) * scale;
    const World::Placing angular = {.mass = kPieceMass, .pose = pose};
    const World::Placing round = {.mass = kPieceMass, .pose = pose, .surface = kRound};
    switch (kind) {
      case 0:
        world->AddBox(btVector3(r, r * btScalar(0.75), r), angular);
        break;
      case 1:
        world->AddSphere(r, round);
        break;
      case 2:
        world->AddCylinder(r, 2 * r, round);
        break;
      case 3:
        world->AddCapsule(r * btScalar(0.8), r, round);
        break;
      default:
        world->AddConvexHull(hull, angular);
    }
  }
};

}  // namespace

SceneInfo RubbleScene() {
  return {.name = "rubble",
          .description = "Boxes, balls, cylinders, capsules and stones dropped into a pit",
          .size_means = "pieces",
          .default_size = 600,
          .min_size = 5,
          .max_size = 5000,
          .motion = SceneInfo::Motion::kComesToRest,
          .known_facts = RubbleFacts,
          .make = MakeThat<Rubble>};
}

}  // namespace cairn::bench
