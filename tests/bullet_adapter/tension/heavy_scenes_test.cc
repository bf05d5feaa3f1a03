// SPDX-License-Identifier: MIT
// Scenes of heavy things on light ones. Islands with motors are left to sweeps as Cairn comes,
// which is too little for crane and truck (docs/lab/steps.md): these have a step in each frame
// here.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "cairn/bullet/constraint_solver.h"
#include "scenes/facts.h"
#include "tests/bullet_adapter/scene_world.h"

namespace cairn::test {
namespace {

struct HeavyScene {
  bullet::ConstraintSolver solver;
  SceneWorld scene;
  double gap = 0, fastest = 0;  ///< largest so far

  explicit HeavyScene(std::string_view name, StepPolicy policy = StepPolicy::kMeasured)
      : solver({.step_policy = policy}), scene(name, &solver) {}

  void Run(int frames) {
    for (int i = 0; i < frames; ++i) {
      scene.Step(1);
      gap = std::max(gap, bench::LargestJointGap(scene.world()));
      fastest = std::max(fastest, bench::LargestSpeed(scene.world()));
    }
  }
  btRigidBody* body(size_t place) { return scene.world().dynamic_bodies()[place]; }
};

// The load hangs 14 m below the jib, on a radius of 10 m; 0.2 rad/s turn it by 2 rad in 10 s.
TEST(HeavyScenes, CraneTurnsWithItsLoad) {
  HeavyScene crane("crane", StepPolicy::kAlways);
  const double height = crane.body(22)->getCenterOfMassPosition().y();
  crane.Run(600);
  EXPECT_LT(crane.gap, 0.02);
  EXPECT_LT(crane.fastest, 10);
  const btVector3 along = crane.body(0)->getWorldTransform().getBasis().getColumn(0);
  EXPECT_NEAR(std::abs(std::atan2(-along.z(), along.x())), 2, 0.2);
  EXPECT_NEAR(crane.body(22)->getCenterOfMassPosition().y(), height, 1);
}

TEST(HeavyScenes, ChandelierHangsStill) {
  HeavyScene chandelier("chandelier");
  chandelier.Run(600);
  const bench::SceneFacts facts = chandelier.scene.Measure();
  EXPECT_EQ(facts.verdict, bench::SceneFacts::Verdict::kStanding);
  EXPECT_LT(std::abs(facts.height_lost_m), 0.005);
  EXPECT_LT(chandelier.gap, 0.005);
  EXPECT_LT(bench::LargestSpeed(chandelier.scene.world()), 0.05);
}

// The far bank begins at 6 m.
TEST(HeavyScenes, TruckCrossesItsBridge) {
  HeavyScene truck("truck", StepPolicy::kAlways);
  truck.Run(600);
  const btVector3 at = truck.body(24)->getCenterOfMassPosition();
  EXPECT_GT(at.x(), 6);
  EXPECT_GT(at.y(), 5.5);
  EXPECT_NEAR(at.z(), 0, 1);
  EXPECT_LT(truck.gap, 0.1);
}

TEST(HeavyScenes, SlabStandsOnItsColumns) {
  HeavyScene slab("slab");
  slab.Run(600);
  EXPECT_EQ(slab.scene.Measure().verdict, bench::SceneFacts::Verdict::kStanding);
  EXPECT_LT(slab.scene.Measure().height_lost_m, 0.02);
}

TEST(HeavyScenes, SeesawTiltsToTheGround) {
  HeavyScene seesaw("seesaw");
  seesaw.Run(240);
  const btVector3 right = seesaw.body(0)->getWorldTransform() * btVector3(2, 0, 0);
  EXPECT_NEAR(right.y(), 0.05, 0.03);
  EXPECT_LT(bench::LargestSpeed(seesaw.scene.world()), 0.1);
  EXPECT_LT(seesaw.gap, 0.005);
}

// A crate bridge swings, and comes down: what it has at most is what it began with. Without
// geometric stiffness it gains 5 %.
TEST(HeavyScenes, CrateBridgeGainsNoEnergy) {
  HeavyScene bridge("crate-bridge");
  const double start = bench::TotalEnergy(bridge.scene.world());
  double most = start;
  for (int frame = 0; frame < 1200; ++frame) {
    bridge.Run(1);
    most = std::max(most, bench::TotalEnergy(bridge.scene.world()));
  }
  EXPECT_LT(most - start, 0.005 * start);
  EXPECT_LT(bridge.gap, 0.05);
}

}  // namespace
}  // namespace cairn::test
