// SPDX-License-Identifier: MIT
// A world that Bullet's serializer saved comes back as a scene: bodies, joints, gravity.
#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "play/session.h"
#include "run/imported_scene.h"
#include "run/scene_run.h"
#include "scenes/facts.h"
#include "scenes/scene.h"
#include "support/failure.h"

namespace cairn::cli {
namespace {

std::string PathOf(const std::string& name) { return testing::TempDir() + name; }

/// Saves a scene after some frames, as PyBullet's saveBullet() does.
void Save(bench::World* world, const std::string& path) {
  btDefaultSerializer serializer;
  world->bullet()->serialize(&serializer);
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(serializer.getBufferPointer()),
             serializer.getCurrentBufferSize());
}

TEST(Import, BringsBackBodiesJointsAndGravity) {
  btSequentialImpulseConstraintSolver solver;
  bench::World saved(&solver);
  const auto scene = bench::Make(*bench::FindScene("ragdolls"));
  scene->Build(&saved, {.size = 1});
  saved.bullet()->setGravity(btVector3(0, 0, btScalar(-1.6)));
  for (int frame = 0; frame < 20; ++frame) saved.Step();
  Save(&saved, PathOf("ragdoll.bullet"));

  const SceneChoice choice = ImportScene(PathOf("ragdoll.bullet"), 0);
  EXPECT_EQ(choice.info->name, "ragdoll.bullet");
  bench::World world(&solver);
  const auto imported = choice.make();
  imported->Build(&world, {});
  EXPECT_EQ(world.bullet()->getGravity(), btVector3(0, 0, btScalar(-1.6)));
  EXPECT_EQ(world.joints().size(), saved.joints().size());
  ASSERT_EQ(world.dynamic_bodies().size(), saved.dynamic_bodies().size());
  for (size_t i = 0; i < world.dynamic_bodies().size(); ++i) {
    const btRigidBody &is = *world.dynamic_bodies()[i], &was = *saved.dynamic_bodies()[i];
    EXPECT_NEAR(is.getMass(), was.getMass(), 1e-5 * was.getMass());
    // positions are saved whole
    EXPECT_LT((is.getCenterOfMassPosition() - was.getCenterOfMassPosition()).length(), 1e-6);
    // Bullet's importer leaves velocities in the file
    EXPECT_EQ(is.getLinearVelocity(), btVector3(0, 0, 0));
  }
  for (int frame = 0; frame < 60; ++frame) world.Step();
  for (const btRigidBody* body : world.dynamic_bodies()) {
    EXPECT_TRUE(std::isfinite(body->getCenterOfMassPosition().length2()));
  }
}

TEST(Import, IsDrivenFrameByFrameLikeAnyScene) {
  btSequentialImpulseConstraintSolver solver;
  bench::World saved(&solver);
  bench::Make(*bench::FindScene("tower"))->Build(&saved, {.size = 3});
  Save(&saved, PathOf("driven.bullet"));

  StateRun run(ImportScene(PathOf("driven.bullet"), 0));
  run.Skip(5);
  EXPECT_EQ(run.Record().bodies.size(), 4) << "three boxes, and the ground";
  EXPECT_EQ(run.frame(), 6);
}

TEST(Import, LeavesTheSolverSettingsOfTheScenes) {
  btSequentialImpulseConstraintSolver solver;
  bench::World saved(&solver);
  const auto scene = bench::Make(*bench::FindScene("tower"));
  scene->Build(&saved, {.size = 3});
  saved.solver_info().m_numIterations = 77;
  Save(&saved, PathOf("tower.bullet"));

  bench::World world(&solver);
  ImportScene(PathOf("tower.bullet"), 0).make()->Build(&world, {});
  EXPECT_EQ(world.solver_info().m_numIterations, 10);
  EXPECT_EQ(world.dynamic_bodies().size(), 3);
}

TEST(Import, PlaysBesideItself) {
  btSequentialImpulseConstraintSolver solver;
  bench::World saved(&solver);
  const auto scene = bench::Make(*bench::FindScene("ragdolls"));
  scene->Build(&saved, {.size = 2});
  Save(&saved, PathOf("ragdolls.bullet"));

  play::Controls controls;
  controls.scene.scene = PathOf("ragdolls.bullet");
  play::Session session(controls);
  for (int i = 0; i < 30; ++i) session.Step();
  session.Restart();
  for (int i = 0; i < 30; ++i) session.Step();
  for (const int side : {0, 1}) {
    EXPECT_EQ(session.player(side).failure(), "");
    EXPECT_EQ(session.player(side).world().joints().size(), saved.joints().size());
    EXPECT_GT(bench::ContactPoints(session.player(side).world()), 0);
  }
}

TEST(Import, RefusesAWorldInWhichNothingMoves) {
  btSequentialImpulseConstraintSolver solver;
  bench::World saved(&solver);
  saved.AddGround(10);
  Save(&saved, PathOf("ground.bullet"));
  EXPECT_THROW(ImportScene(PathOf("ground.bullet"), 0), Failure);
  EXPECT_THROW(ImportScene(PathOf("there_is_none.bullet"), 0), Failure);
}

}  // namespace
}  // namespace cairn::cli
