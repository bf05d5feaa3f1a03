// SPDX-License-Identifier: MIT
#include "bullet_adapter/src/contacts/friction_directions.h"

#include <gtest/gtest.h>

#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>

#include <random>

#include "cairn/bullet/constraint_solver.h"
#include "scenes/world.h"

namespace cairn::test {
namespace {

using bullet::ChooseDirections;

constexpr int kTwo = SOLVER_USE_2_FRICTION_DIRECTIONS;
constexpr int kFixed = SOLVER_DISABLE_VELOCITY_DEPENDENT_FRICTION_DIRECTION;

class FrictionDirections : public testing::Test {
 protected:
  btVector3 RandomVector() {
    std::normal_distribution<double> normal;
    const auto next = [&] { return static_cast<btScalar>(normal(random_)); };
    return {next(), next(), next()};
  }

  btCollisionObject a_, b_;
  btPersistentManifold manifold_{&a_, &b_, 0, 1, 1};
  std::mt19937 random_{5};
};

/// What the solver writes after a substep, and then what the narrow phase overwrites.
btVector3 LeaveFriction(const bullet::FrictionDirections& directions, btManifoldPoint* point) {
  point->m_appliedImpulseLateral1 = btScalar(0.7);
  point->m_appliedImpulseLateral2 = btScalar(-0.4);
  point->m_prevRHS = directions.left.heading;
  btPlaneSpace1(point->m_normalWorldOnB, point->m_lateralFrictionDir1,
                point->m_lateralFrictionDir2);
  return directions.first * btScalar(0.7) + directions.second * btScalar(-0.4);
}

TEST_F(FrictionDirections, AreFoundAgainAfterTheNarrowPhaseOverwroteThem) {
  for (int i = 0; i < 200; ++i) {
    btManifoldPoint point;
    point.m_normalWorldOnB = RandomVector().normalized();
    const auto directions =
        ChooseDirections(i % 2 == 0 ? kTwo : kTwo | kFixed, RandomVector(), manifold_, &point);
    const btVector3 friction = LeaveFriction(directions, &point);
    const auto next = ChooseDirections(kTwo, RandomVector(), manifold_, &point);
    EXPECT_LT((bullet::LeftFriction(point, next) - friction).length(), 1e-5);
  }
}

TEST_F(FrictionDirections, FollowTheVelocityUnlessItIsNothing) {
  btManifoldPoint point;
  point.m_normalWorldOnB = {0, 1, 0};
  const auto sliding = ChooseDirections(kTwo, {3, 7, 4}, manifold_, &point);
  EXPECT_NEAR(sliding.first.x(), 0.6, 1e-6);
  EXPECT_NEAR(sliding.first.y(), 0, 1e-6);
  EXPECT_NEAR(sliding.first.z(), 0.8, 1e-6);
  EXPECT_FALSE(sliding.as_left);
  EXPECT_NEAR(sliding.slide, 5, 1e-5);

  const auto resting = ChooseDirections(kTwo, {0, 7, 0}, manifold_, &point);
  btVector3 x, y;
  btPlaneSpace1(point.m_normalWorldOnB, x, y);
  EXPECT_EQ((resting.first - x).length(), 0);
  EXPECT_EQ((resting.second - y).length(), 0);
  EXPECT_TRUE(resting.as_left);
  EXPECT_EQ(resting.slide, 0);

  // a skate that glides is held across its way
  b_.setAnisotropicFriction({btScalar(0.1), 1, 1});
  EXPECT_EQ(ChooseDirections(kTwo, {3, 7, 4}, manifold_, &point).slide, 0);
}

/// How far planks that slide to rest end beside their way, as a part of it: the mean of some that
/// lie turned.
double Veered(const Settings& settings, const bullet::Options& options) {
  double beside = 0, ahead = 0;
  for (int turn = 0; turn < 20; ++turn) {
    bullet::ConstraintSolver solver(settings, options);
    bench::World world(&solver);
    world.AddGround(80);
    world.solver_info().m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
    const btVector3 half(btScalar(0.3), btScalar(0.1), btScalar(0.8));
    const auto angle = static_cast<btScalar>(0.05 + 0.15 * turn);
    btRigidBody* const plank =
        world.AddBox(half, {.mass = 1,
                            .pose = btTransform(btQuaternion({0, 1, 0}, angle), {0, half.y(), 0}),
                            .surface = {.friction = btScalar(turn % 2 == 0 ? 0.2 : 0.4)}});
    plank->setLinearVelocity({6, 0, 0});
    for (int i = 0; i < 400; ++i) world.Step();
    EXPECT_LT(plank->getLinearVelocity().length(), 0.01);
    const btVector3 end = plank->getWorldTransform().getOrigin();
    beside += btFabs(end.z());
    ahead += end.x();
  }
  return beside / ahead;
}

TEST(Friction, LetsPlanksSlideStraightAhead) {
  EXPECT_LT(Veered({}, {}), 0.003);
  EXPECT_LT(Veered({.path = Path::kReference}, {}), 0.003);
  EXPECT_GT(Veered({}, {.two_friction_directions = false}), 0.02) << "each for itself";
}

}  // namespace
}  // namespace cairn::test
