// SPDX-License-Identifier: MIT
// What may arrive at a solver of Bullet besides well-behaved worlds, and what Mode::kFast leaves in
// contact points and bodies. Groups are handed over directly.
#include <gtest/gtest.h>

#include <BulletCollision/CollisionDispatch/btGhostObject.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "cairn/bullet/constraint_solver.h"
#include "measure/instrumented_solver.h"
#include "tests/bullet_adapter/scene_world.h"

namespace cairn::test {
namespace {

using bench::At;
using bench::Substep;
using bench::World;

constexpr btScalar kTimeStep = btScalar(1) / 60;

btContactSolverInfo Info() {
  btContactSolverInfo info;
  info.m_timeStep = kTimeStep;
  return info;
}

std::unique_ptr<btRigidBody> MakeBody(btScalar mass, const btTransform& pose) {
  btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, nullptr,
                                                btVector3(mass, 2 * mass, 3 * mass) / 10);
  info.m_startWorldTransform = pose;
  auto body = std::make_unique<btRigidBody>(info);
  body->setAngularVelocity({3, -2, 5});
  body->updateInertiaTensor();
  return body;
}

/// A manifold of one point at the origin, 1 mm deep, with the normal upwards on b.
std::unique_ptr<btPersistentManifold> Touch(const btCollisionObject* a,
                                            const btCollisionObject* b) {
  auto manifold = std::make_unique<btPersistentManifold>(a, b, 0, btScalar(0.02), btScalar(1e18));
  btManifoldPoint point({0, 0, 0}, {0, 0, 0}, {0, 1, 0}, btScalar(-0.001));
  point.m_positionWorldOnA = point.m_positionWorldOnB = {0, 0, 0};
  point.m_combinedFriction = btScalar(0.5);
  manifold->addManifoldPoint(point);
  return manifold;
}

void Solve(btConstraintSolver* solver, std::vector<btCollisionObject*> bodies,
           std::vector<btPersistentManifold*> manifolds, const btContactSolverInfo& info) {
  solver->prepareSolve(0, 0);
  solver->solveGroup(bodies.data(), static_cast<int>(bodies.size()), manifolds.data(),
                     static_cast<int>(manifolds.size()), nullptr, 0, info, nullptr, nullptr);
  solver->allSolved(info, nullptr);
}

void ExpectEqual(const btVector3& a, const btVector3& b) {
  EXPECT_EQ(a.x(), b.x());
  EXPECT_EQ(a.y(), b.y());
  EXPECT_EQ(a.z(), b.z());
}

class GyroscopicMode : public testing::TestWithParam<int> {};

TEST_P(GyroscopicMode, TurnsAFreeBodyAsBulletDoes) {
  // a light one, too, whose inertia has a determinant that Bullet does not divide by
  for (const btScalar mass : {btScalar(2), btScalar(0.01)}) {
    const auto turned_by = [mass](btConstraintSolver* solver) {
      auto body = MakeBody(mass, At(0, 0, 0));
      body->setMassProps(mass, mass * btVector3(btScalar(0.1), btScalar(0.3), btScalar(0.35)));
      body->setFlags(GetParam());
      const btTransform turned(btQuaternion(1, 2, 3), {0, 0, 0});
      body->setWorldTransform(turned);
      body->updateInertiaTensor();
      body->setAngularVelocity({4, -7, 5});
      body->applyCentralForce({1, 2, 3});
      body->applyTorque({3, 2, 1});
      Solve(solver, {body.get()}, {}, Info());
      return std::pair(body->getLinearVelocity(), body->getAngularVelocity());
    };
    btSequentialImpulseConstraintSolver bullets;
    bullet::ConstraintSolver ours;
    const auto expected = turned_by(&bullets), actual = turned_by(&ours);
    ExpectEqual(actual.first, expected.first);
    ExpectEqual(actual.second, expected.second);
  }
}

// More than are done at a time, in all attitudes.
TEST_P(GyroscopicMode, TurnsManyFreeBodiesAsBulletDoes) {
  constexpr int kBodies = 100;
  const auto spins_after = [](btConstraintSolver* solver) {
    std::vector<std::unique_ptr<btRigidBody>> bodies;
    std::vector<btCollisionObject*> objects;
    for (int i = 0; i < kBodies; ++i) {
      const auto angle = [i](int k) { return btScalar((37 * i + 11 * k) % 629 - 314) / 100; };
      const btScalar mass = btScalar(0.01) * (1 + i % 5 * 40);
      bodies.push_back(MakeBody(mass, At(0, btScalar(3) * i, 0)));
      btRigidBody& body = *bodies.back();
      body.setMassProps(mass,
                        mass * btVector3(btScalar(0.1), btScalar(0.3), i % 7 * btScalar(0.1)));
      body.setFlags(i % 11 == 0 ? 0 : GetParam());
      const btQuaternion turned(angle(1), angle(2), angle(3));
      body.setWorldTransform(btTransform(turned, {0, btScalar(3) * i, 0}));
      body.updateInertiaTensor();
      body.setAngularVelocity({angle(4) * 3, angle(5), i % 13 == 0 ? 0 : angle(6)});
      objects.push_back(&body);
    }
    Solve(solver, objects, {}, Info());
    std::vector<btVector3> spins;
    for (const auto& body : bodies) spins.push_back(body->getAngularVelocity());
    return spins;
  };
  btSequentialImpulseConstraintSolver bullets;
  bullet::ConstraintSolver ours;
  const auto expected = spins_after(&bullets), actual = spins_after(&ours);
  for (int i = 0; i < kBodies; ++i) ExpectEqual(actual[i], expected[i]);
}

INSTANTIATE_TEST_SUITE_P(Every, GyroscopicMode,
                         testing::Values(0, BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT,
                                         BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD,
                                         BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY));

TEST(ObjectContract, AFallingBodyLandsOnAGhostAsOnTheWorld) {
  bullet::ConstraintSolver solver;
  auto body = MakeBody(1, At(0, btScalar(0.5), 0));
  body->setAngularVelocity({0, 0, 0});
  body->setLinearVelocity({0, -2, 0});
  btGhostObject ghost;
  const auto manifold = Touch(body.get(), &ghost);
  Solve(&solver, {&ghost, body.get()}, {manifold.get()}, Info());
  // 0.001 m deep: pushed out at a fifth of it per step
  EXPECT_NEAR(body->getLinearVelocity().y(), 0.2 * 0.001 * 60, 1e-5);
  EXPECT_FALSE(solver.fell_back());
  EXPECT_EQ(ghost.getCompanionId(), -1);
}

TEST(ObjectContract, ManifoldsOfStaticBodiesAndWithoutPointsAreNothing) {
  bullet::ConstraintSolver solver;
  const auto ground = MakeBody(0, At(0, 0, 0)), wall = MakeBody(0, At(0, 1, 0));
  const auto body = MakeBody(1, At(0, btScalar(0.5), 0));
  const auto both_static = Touch(ground.get(), wall.get());
  const auto empty = Touch(body.get(), ground.get());
  empty->clearManifold();
  const btVector3 spin = body->getAngularVelocity();
  body->setFlags(0);
  Solve(&solver, {body.get()}, {both_static.get(), empty.get()}, Info());
  EXPECT_TRUE(solver.report().ok());
  EXPECT_TRUE(solver.impulses().empty());
  ExpectEqual(body->getAngularVelocity(), spin);
}

TEST(ObjectContract, NothingIsWrittenToWhatDoesNotReact) {
  bullet::ConstraintSolver solver;
  const auto body = MakeBody(1, At(0, btScalar(0.5), 0)), table = MakeBody(5, At(0, 0, 0));
  table->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
  table->setLinearVelocity({1, 0, 0});
  table->setAngularVelocity({0, 0, 0});
  table->setCompanionId(-7);
  const auto manifold = Touch(body.get(), table.get());
  Solve(&solver, {body.get()}, {manifold.get()}, Info());
  ExpectEqual(table->getLinearVelocity(), {1, 0, 0});
  EXPECT_EQ(table->getCompanionId(), -7);
}

TEST(ObjectContract, BodiesThatOnlyAManifoldKnowsMove) {
  bullet::ConstraintSolver solver;
  const auto upper = MakeBody(1, At(0, btScalar(0.5), 0)), lower = MakeBody(1, At(0, -1, 0));
  upper->setAngularVelocity({0, 0, 0});
  lower->setAngularVelocity({0, 0, 0});
  upper->setLinearVelocity({0, -2, 0});
  const auto manifold = Touch(upper.get(), lower.get());
  Solve(&solver, {}, {manifold.get()}, Info());
  // equal masses that do not bounce share the speed, but for the 1 mm
  EXPECT_NEAR(lower->getLinearVelocity().y(), -1, 0.01);
}

TEST(ObjectContract, ImpulsesOfPointsAreBulletsWithEitherNumberOfDirections) {
  for (const int mode :
       {0, +SOLVER_USE_WARMSTARTING, SOLVER_USE_WARMSTARTING | SOLVER_USE_2_FRICTION_DIRECTIONS}) {
    const auto impulses_with = [mode](btConstraintSolver* solver) {
      auto body = MakeBody(1, At(0, btScalar(0.5), 0)), ground = MakeBody(0, At(0, -1, 0));
      body->setAngularVelocity({0, 0, 0});
      body->setLinearVelocity({btScalar(0.3), -2, btScalar(0.4)});
      const auto manifold = Touch(body.get(), ground.get());
      manifold->getContactPoint(0).m_appliedImpulseLateral2 = btScalar(0.125);
      btContactSolverInfo info = Info();
      info.m_solverMode = mode;
      info.m_numIterations = 100;
      Solve(solver, {body.get()}, {manifold.get()}, info);
      const btManifoldPoint& point = manifold->getContactPoint(0);
      return std::vector<double>{point.m_appliedImpulse,          point.m_appliedImpulseLateral1,
                                 point.m_appliedImpulseLateral2,  point.m_lateralFrictionDir1.x(),
                                 point.m_lateralFrictionDir1.z(), point.m_lateralFrictionDir2.x()};
    };
    btSequentialImpulseConstraintSolver bullets;
    bullet::ConstraintSolver ours({.k_sm = 0, .acceleration = Acceleration::kNone});
    const auto expected = impulses_with(&bullets), actual = impulses_with(&ours);
    for (size_t i = 0; i < expected.size(); ++i) {
      EXPECT_NEAR(actual[i], expected[i], 1e-5) << i << " in mode " << mode;  // sweeps in floats
    }
  }
}

/// Split impulses do not depend on anything else: they are swept in Bullet's order.
TEST(ObjectContract, DeepPenetrationIsPushedOutAsFarAsByBullet) {
  btSequentialImpulseConstraintSolver driver, bullets;
  bullet::ConstraintSolver ours;
  bench::InstrumentedSolver instrumented(&driver);
  World world(&instrumented);
  world.AddGround(5);
  for (int i = 0; i < 4; ++i) {
    world.AddBox(btVector3(1, 1, 1) / 2,
                 {.mass = btScalar(1 + i),
                  .pose = At(btScalar(0.1) * btScalar(i), btScalar(0.4) + btScalar(0.9) * i, 0)});
  }
  const auto origins_after = [](const Substep& substep, btConstraintSolver* solver,
                                const btContactSolverInfo& info) {
    substep.Restore();
    substep.SolveWith(solver, info, nullptr);
    std::vector<btVector3> origins;
    for (const btRigidBody* body : substep.bodies()) {
      origins.push_back(body->getWorldTransform().getOrigin());
      origins.push_back(body->getWorldTransform().getBasis()[0]);
    }
    return origins;
  };
  btScalar moved = 0;
  for (int frame = 0; frame < 10; ++frame) {
    instrumented.ProbeNext([&](Substep* substep, const btContactSolverInfo& info) {
      const auto before = substep->bodies()[0]->getWorldTransform().getOrigin();
      const auto expected = origins_after(*substep, &bullets, info);
      const auto actual = origins_after(*substep, &ours, info);
      for (size_t i = 0; i < expected.size(); ++i) {
        // positions of some metres, after ten sweeps
        EXPECT_LT((actual[i] - expected[i]).length(), 100 * kBulletEpsilon);
      }
      moved += (expected[0] - before).length();
    });
    world.Step();
  }
  EXPECT_GT(moved, 0.01);
}

TEST(ObjectContract, AnalyticsAreFilled) {
  bullet::ConstraintSolver solver;
  const auto body = MakeBody(1, At(0, btScalar(0.5), 0)), ground = MakeBody(0, At(0, -1, 0));
  const auto manifold = Touch(body.get(), ground.get());
  Solve(&solver, {body.get()}, {manifold.get()}, Info());
  EXPECT_EQ(solver.m_analyticsData.m_numSolverCalls, 1);
  EXPECT_EQ(solver.m_analyticsData.m_numBodies, 1);
  EXPECT_EQ(solver.m_analyticsData.m_numContactManifolds, 1);
  EXPECT_EQ(solver.m_analyticsData.m_numIterationsUsed, solver.report().sweeps);
  EXPECT_EQ(solver.m_analyticsData.m_islandId, 0);
}

TEST(ObjectContract, TheProblemAndItsImpulsesAreThoseOfTheReport) {
  bullet::ConstraintSolver solver;
  SceneWorld world("pyramid", &solver);
  world.Step(5);
  const ContactProblem problem = solver.problem();
  ASSERT_GT(problem.manifolds.size(), 0u);
  ASSERT_EQ(AllRows(problem), solver.impulses().size());
  const Report measured = Measure(solver.problem(), solver.impulses());
  EXPECT_NEAR(measured.residual_max, solver.report().residual_max, 1e-4);
}

TEST(ObjectContract, ANanIsNamedAndForgottenInTheNextSubstep) {
  bullet::ConstraintSolver solver;
  const auto body = MakeBody(1, At(0, btScalar(0.5), 0)), ground = MakeBody(0, At(0, -1, 0));
  const auto manifold = Touch(body.get(), ground.get());
  body->setLinearVelocity({std::numeric_limits<btScalar>::quiet_NaN(), 0, 0});
  Solve(&solver, {body.get()}, {manifold.get()}, Info());
  EXPECT_TRUE(solver.fell_back());
  EXPECT_NE(solver.complaint().find("nan"), std::string::npos) << solver.complaint();

  body->setLinearVelocity({0, 0, 0});
  body->setAngularVelocity({0, 0, 0});
  manifold->getContactPoint(0).m_appliedImpulse = 0;
  Solve(&solver, {body.get()}, {manifold.get()}, Info());
  EXPECT_FALSE(solver.fell_back());
  EXPECT_TRUE(solver.report().ok());
}

}  // namespace
}  // namespace cairn::test
