// SPDX-License-Identifier: MIT
// What is remembered of bodies and joints is not taken for that of others, nor kept for too long.
#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <memory>
#include <new>
#include <vector>

#include "cairn/bullet/constraint_solver.h"
#include "scenes/world.h"
#include "tests/bullet_adapter/any_world.h"

namespace cairn::test {
namespace {

using bench::At;
using bench::ConnectedBodies;
using bench::World;

/// Six light links under half a ton: their inertia is raised.
std::vector<btRigidBody*> HangWeight(World* world, btScalar x = 0) {
  std::vector<btRigidBody*> links;
  const btScalar half = btScalar(0.1);
  for (int i = 0; i < 6; ++i) {
    btRigidBody* const link =
        world->AddBox({btScalar(0.02), half, btScalar(0.02)},
                      {.mass = half, .pose = At(x, -2 * half * btScalar(i), 0), .surface = {}});
    auto joint = i == 0 ? std::make_unique<btPoint2PointConstraint>(*link, btVector3(0, half, 0))
                        : std::make_unique<btPoint2PointConstraint>(
                              *links.back(), *link, btVector3(0, -half, 0), btVector3(0, half, 0));
    world->AddJoint(std::move(joint), ConnectedBodies::kPassThrough);
    links.push_back(link);
  }
  btRigidBody* const weight = world->AddBox(
      btVector3(1, 1, 1) / 2, {.mass = 500, .pose = At(x, btScalar(-1.6), 0), .surface = {}});
  world->AddJoint(
      std::make_unique<btPoint2PointConstraint>(*links.back(), *weight, btVector3(0, -half, 0),
                                                btVector3(0, btScalar(0.5), 0)),
      ConnectedBodies::kPassThrough);
  return links;
}

TEST(Tension, OfALinkEndsWithItsJoints) {
  bullet::ConstraintSolver solver;
  World world(&solver);
  const std::vector<btRigidBody*> links = HangWeight(&world);
  for (int i = 0; i < 60; ++i) world.Step();
  // the third is cut out, and flies
  btTypedConstraint* const above = world.joints()[2];
  btTypedConstraint* const below = world.joints()[3];
  world.Remove(above);
  world.Remove(below);
  links[2]->setWorldTransform(At(50, 0, 0));
  links[2]->setAngularVelocity({0, 0, 5});
  for (int i = 0; i < 30; ++i) world.Step();
  EXPECT_NEAR(links[2]->getAngularVelocity().z(), 5, 1e-3);
}

// Bullet gives the number of a body that goes to the last one.
TEST(Tension, IsNotThatOfTheBodyThatHadTheNumberBefore) {
  bullet::ConstraintSolver solver;
  World world(&solver);
  const std::vector<btRigidBody*> links = HangWeight(&world);
  btRigidBody* const free =
      world.AddBox({btScalar(0.02), btScalar(0.1), btScalar(0.02)},
                   {.mass = btScalar(0.1), .pose = At(50, 0, 0), .surface = {}});
  for (int i = 0; i < 60; ++i) world.Step();
  world.Remove(links[5]);
  free->setAngularVelocity({0, 0, 5});
  for (int i = 0; i < 30; ++i) world.Step();
  EXPECT_NEAR(free->getAngularVelocity().z(), 5, 1e-3);
}

// Nor by one with a joint of its own.
TEST(Tension, OfARopeThatGoesIsNotThatOfWheelsThatStay) {
  bullet::ConstraintSolver solver;
  World world(&solver);
  const std::vector<btRigidBody*> links = HangWeight(&world);
  std::vector<btRigidBody*> wheels;
  for (int i = 0; i < 6; ++i) {
    wheels.push_back(world.AddCylinder(
        btScalar(0.02), btScalar(0.02),
        {.mass = btScalar(0.1), .pose = At(btScalar(50 + i), 0, 0), .surface = {}}));
    world.AddJoint(
        std::make_unique<btHingeConstraint>(*wheels.back(), btVector3(0, 0, 0), btVector3(0, 1, 0)),
        ConnectedBodies::kPassThrough);
  }
  for (int i = 0; i < 60; ++i) world.Step();
  for (btRigidBody* wheel : wheels) wheel->setAngularVelocity({0, 10, 0});
  for (btRigidBody* link : links) world.Remove(link);
  for (int i = 0; i < 30; ++i) world.Step();
  for (btRigidBody* wheel : wheels) EXPECT_NEAR(wheel->getAngularVelocity().y(), 10, 1e-2);
  EXPECT_EQ(solver.place_of(*links[0]), -1) << "it has gone";
  const int place = solver.place_of(*wheels[0]);
  ASSERT_GE(place, 0);
  EXPECT_FLOAT_EQ(solver.problem().bodies[place].inv_mass, 10);
}

// At the address of one that carried a weight, and whose last row carried nothing.
TEST(JointMemory, DoesNotStartANewJoint) {
  bullet::ConstraintSolver solver;
  World world(&solver);
  btRigidBody* const ball =
      world.AddSphere(btScalar(0.1), {.mass = 1, .pose = At(0, -1, 0), .surface = {}});
  alignas(btPoint2PointConstraint) static unsigned char place[sizeof(btPoint2PointConstraint)];
  auto* joint = new (place) btPoint2PointConstraint(*ball, btVector3(0, 1, 0));
  world.bullet()->addConstraint(joint);
  for (int i = 0; i < 30; ++i) world.Step();
  ASSERT_GT(solver.impulses()[1], 0.1);

  world.bullet()->removeConstraint(joint);
  joint->~btPoint2PointConstraint();
  ball->setGravity({0, 0, 0});
  ball->setWorldTransform(At(0, -1, 0));
  ball->setLinearVelocity({0, 0, 0});
  ball->setAngularVelocity({0, 0, 0});
  ball->clearForces();
  joint = new (place) btPoint2PointConstraint(*ball, btVector3(0, 1, 0));
  world.bullet()->addConstraint(joint);
  world.solver_info().m_numIterations = 0;
  world.Step();
  EXPECT_EQ(ball->getLinearVelocity().y(), 0);
  world.bullet()->removeConstraint(joint);
  joint->~btPoint2PointConstraint();
}

/// Of boxes on a floor, beside which more walls are built than the world had bodies.
std::vector<btScalar> HeightsBesideNewWalls(int threads) {
  bullet::ConstraintSolver solver({.threads = threads});
  World world(&solver);
  world.AddGround(200);
  for (int i = 0; i < 600; ++i) {
    world.AddBox(btVector3(1, 1, 1) / 2,
                 {.mass = 1,
                  .pose = At(btScalar(3 * (i % 30)), btScalar(0.49), btScalar(3 * (i / 30))),
                  .surface = {}});
  }
  for (int i = 0; i < 3; ++i) world.Step();
  for (int i = 0; i < 1200; ++i) {
    world.AddBox(btVector3(1, 1, 1) / 2,
                 {.mass = 0,
                  .pose = At(btScalar(3 * (i % 30)) + btScalar(0.99), 1, btScalar(3 * (i / 30))),
                  .surface = {}});
  }
  for (int i = 0; i < 3; ++i) world.Step();
  std::vector<btScalar> heights;
  for (const btRigidBody* body : world.dynamic_bodies()) {
    heights.push_back(body->getCenterOfMassPosition().y());
  }
  return heights;
}

// Pointers into a table that grows are not followed; AddressSanitizer would see it.
TEST(BodyTable, GrowsWhileManifoldsAreReadOnThreads) {
  EXPECT_EQ(HeightsBesideNewWalls(2), HeightsBesideNewWalls(1));
}

#if defined(__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 33)
TEST(Reset, GivesMemoryBack) {
  const auto in_use = [] { return static_cast<double>(mallinfo2().uordblks); };
  auto solver = std::make_unique<bullet::ConstraintSolver>();
  {
    World world(solver.get());
    for (int i = 0; i < 30; ++i) HangWeight(&world, 5 * i);
    for (int i = 0; i < 30; ++i) world.Step();
  }
  const double full = in_use();
  solver->reset();
  const double empty = in_use();
  solver.reset();
  const double none = in_use();
  EXPECT_LE(empty - none, 0.05 * (full - none));
}
#endif

}  // namespace
}  // namespace cairn::test
