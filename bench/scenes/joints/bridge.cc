// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <vector>

#include "scenes/joints/joint_frames.h"
#include "scenes/scene.h"

// The bridge is built in the shape in which it hangs at rest, so that whatever it sinks later is
// the solver's error. Each joint is two pins, at the two sides of the bridge: six rows, one
// redundant.
namespace cairn::bench {
namespace {

constexpr btScalar kPitch = 1;                                         // of the joints [m]
constexpr btScalar kPlankGap = btScalar(0.05);                         // [m]
constexpr btScalar kPlankThickness = btScalar(0.16), kPlankWidth = 2;  // [m]
constexpr btScalar kPinSide = btScalar(0.9);                           // from the middle [m]
constexpr btScalar kPlankMass = 12, kCrateMass = 8;                    // [kg]
constexpr btScalar kCrateSide = btScalar(0.7);                         // [m]
constexpr btScalar kCrateRow = btScalar(0.5);                          // from the middle [m]
constexpr btScalar kMaySink = btScalar(0.5);                           // [m]
// Crates must not slide down planks of 18 degrees.
constexpr Surface kRough = {.friction = btScalar(0.8)};
constexpr double kClearance = 4;  // of the lowest joint above the ground [m]
// Steep ends pull less. Planks of mass m and length L under tension T turn at sqrt(12 T / (m L)),
// and in a flat bridge that is more than steps of 1/60 s can follow, whatever the solver.
constexpr double kEndSlope = 0.7;  // [rad]

/// Two crates side by side on every second plank of the middle, the same in both halves.
int CrateColumns(int planks) { return planks * 3 / 40 * 2; }

bool IsLoaded(int plank, int planks) {
  const int from_end = std::min(plank, planks - 1 - plank);
  const int from_middle = (planks + 1) / 2 - 1 - from_end;
  return from_middle % 2 == 1 && from_middle < CrateColumns(planks);
}

/// Where the parts are when all forces balance.
struct Shape {
  std::vector<btVector3> joints;    // from pillar to pillar, in the middle of the bridge [m]
  std::vector<btTransform> planks;  // x along the plank
};

/// The horizontal force H is the same everywhere; the vertical force V grows by the weight W of
/// each plank with its load. No torque acts on a plank if its slope is the mean of its ends' V,
/// over H.
Shape HangingShape(int planks) {
  double total = 0;
  const auto load = [&](int i) { return kPlankMass + (IsLoaded(i, planks) ? 2 * kCrateMass : 0); };
  for (int i = 0; i < planks; ++i) total += load(i);

  double vertical = -total / 2;
  const double horizontal = (total - load(0)) / 2 / std::tan(kEndSlope);
  std::vector<double> slopes, x = {0}, y = {0};
  for (int i = 0; i < planks; ++i) {
    slopes.push_back(std::atan2(vertical + load(i) / 2, horizontal));
    vertical += load(i);
    x.push_back(x.back() + kPitch * std::cos(slopes.back()));
    y.push_back(y.back() + kPitch * std::sin(slopes.back()));
  }

  Shape shape;
  const double left = -x.back() / 2, bottom = kClearance - *std::min_element(y.begin(), y.end());
  for (int i = 0; i <= planks; ++i) {
    shape.joints.emplace_back(btScalar(left + x[i]), btScalar(bottom + y[i]), btScalar(0));
  }
  for (int i = 0; i < planks; ++i) {
    shape.planks.emplace_back(btQuaternion(btVector3(0, 0, 1), btScalar(slopes[i])),
                              (shape.joints[i] + shape.joints[i + 1]) / 2);
  }
  return shape;
}

KnownFacts BridgeFacts(int planks) {
  const int crates = 2 * CrateColumns(planks);
  return {.bodies = planks + crates,
          .joints = 2 * (planks + 1),
          .top_height_m = HangingShape(planks).planks.front().getOrigin().y(),
          .mass_kg = double(kPlankMass) * planks + double(kCrateMass) * crates};
}

class Bridge : public Scene {
 public:
  using Scene::Scene;

 protected:
  void AddBodies(World* world, int size) override {
    const Shape shape = HangingShape(size);
    world->AddGround(kPitch * btScalar(size) + 10);
    btRigidBody* previous = AddPillar(world, shape.joints.front(), -1);
    for (int i = 0; i < size; ++i) {
      btRigidBody* plank = AddPlank(world, shape.planks[i]);
      AddPins(world, shape.joints[i], kPinSide, previous, plank);
      if (i == (size - 1) / 2 || i == size / 2) Watch(plank, kMaySink);
      previous = plank;
    }
    AddPins(world, shape.joints.back(), kPinSide, previous,
            AddPillar(world, shape.joints.back(), 1));

    for (int i = 0; i < size; ++i) {
      if (IsLoaded(i, size)) AddCrates(world, shape.planks[i]);
    }
  }

 private:
  /// Static, on the side `outwards` (-1 or 1 along x) of the joint on its edge.
  static btRigidBody* AddPillar(World* world, const btVector3& joint, btScalar outwards) {
    const btVector3 half(kPitch / 2, joint.y() / 2, kPlankWidth / 2);
    return world->AddBox(half, {.pose = At(joint.x() + outwards * half.x(), half.y(), 0)});
  }

  static btRigidBody* AddPlank(World* world, const btTransform& pose) {
    const btVector3 size(kPitch - kPlankGap, kPlankThickness, kPlankWidth);
    return world->AddBox(size / 2, {.mass = kPlankMass, .pose = pose, .surface = kRough});
  }

  static void AddCrates(World* world, const btTransform& plank) {
    const btVector3 half(kCrateSide / 2, kCrateSide / 2, kCrateSide / 2);
    const btScalar y = (kPlankThickness + kCrateSide) / 2;
    for (const btScalar z : {-kCrateRow, kCrateRow}) {
      world->AddBox(half, {.mass = kCrateMass, .pose = plank * At(0, y, z), .surface = kRough});
    }
  }
};

}  // namespace

SceneInfo BridgeScene() {
  return {.name = "bridge",
          .description = "A hanging bridge of planks on pins, loaded with crates",
          .size_means = "planks",
          .default_size = 40,
          .min_size = 10,
          .max_size = 100,
          .motion = SceneInfo::Motion::kComesToRest,
          .known_facts = BridgeFacts,
          .make = MakeThat<Bridge>};
}

}  // namespace cairn::bench
