// SPDX-License-Identifier: MIT
// What Bullet's users rely on besides contacts: joints that break, feedback, overrides, thresholds,
// kinematic and disabled things, worlds that call in other ways.
#include <gtest/gtest.h>

#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>
#include <cfenv>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cairn/bullet/constraint_solver.h"
#include "scenes/facts.h"
#include "scenes/world.h"
#include "tests/bullet_adapter/scene_world.h"
#include "tests/core/support/test_clock.h"

namespace cairn::test {
namespace {

using bench::At;
using bench::ConnectedBodies;
using bench::World;

constexpr btScalar kGravity = btScalar(9.81);
constexpr btScalar kTimeStep = btScalar(1) / 60;

/// A box of 2 kg that hangs from the world by a point 1 m above its centre.
btPoint2PointConstraint* HangBox(World* world) {
  btRigidBody* const box =
      world->AddBox(btVector3(1, 1, 1) / 4, {.mass = 2, .pose = At(0, 5, 0), .surface = {}});
  return static_cast<btPoint2PointConstraint*>(
      world->AddJoint(std::make_unique<btPoint2PointConstraint>(*box, btVector3(0, 1, 0)),
                      ConnectedBodies::kCollide));
}

TEST(Features, JointFeedbackCarriesTheWeight) {
  bullet::ConstraintSolver solver;
  World world(&solver);
  btTypedConstraint* const joint = HangBox(&world);
  btJointFeedback feedback{};
  joint->setJointFeedback(&feedback);
  for (int i = 0; i < 10; ++i) world.Step();

  EXPECT_NEAR(feedback.m_appliedForceBodyA.y(), 2 * kGravity, 1e-3);
}

// What a body does, be it one that no impulse moves, is no error, and nor is what a motor without a
// limit asks for.
TEST(Features, JointsTellWhatOfTheirTargetsTakesBackErrors) {
  bullet::ConstraintSolver solver;
  World world(&solver);
  const btVector3 half = btVector3(1, 1, 1) / 4;
  btRigidBody* const hook = world.AddBox(half, {.mass = 0, .pose = At(0, 5, 0), .surface = {}});
  btRigidBody* const box = world.AddBox(half, {.mass = 2, .pose = At(0, 4, 0), .surface = {}});
  hook->setLinearVelocity({0, 3, 0});
  box->setLinearVelocity({0, 2, 0});
  // the box is 10 cm too low
  world.AddJoint(std::make_unique<btPoint2PointConstraint>(*hook, *box, btVector3(0, 0, 0),
                                                           btVector3(0, btScalar(0.9), 0)),
                 ConnectedBodies::kCollide);
  auto hinge = std::make_unique<btHingeConstraint>(*box, btVector3(0, btScalar(0.9), 0),
                                                   btVector3(0, 1, 0), true);
  hinge->enableAngularMotor(true, 7, BT_LARGE_FLOAT);
  world.AddJoint(std::move(hinge), ConnectedBodies::kCollide);
  world.Step();
  const ContactProblem problem = solver.problem();
  ASSERT_EQ(problem.joints.size(), 2u);
  ASSERT_EQ(problem.joint_errors.size(), problem.joint_rows.size());
  const double closes = 0.1 * 60 * static_cast<double>(world.solver_info().m_erp);
  const bool pin_first = problem.joints[0].rows == 3;  // Bullet sorts them as it likes
  const Joint &of_pin = problem.joints[pin_first ? 0 : 1], &of_hinge = problem.joints[pin_first];
  const int pin = of_pin.first_row;
  EXPECT_NEAR(std::abs(static_cast<double>(problem.joint_errors[pin + 1])), closes, 1e-4);
  EXPECT_GT(std::abs(problem.joint_rows[pin + 1].target), 2);
  const int turns = of_hinge.first_row + 5;
  ASSERT_EQ(of_hinge.rows, 6);
  EXPECT_GT(std::abs(problem.joint_rows[turns].target), 5);
  EXPECT_EQ(problem.joint_errors[turns], 0);
}

TEST(Features, JointBreaksAboveItsThresholdAndNotBelow) {
  const auto enabled_after = [](btScalar threshold) {
    bullet::ConstraintSolver solver;
    World world(&solver);
    btTypedConstraint* const joint = HangBox(&world);
    joint->setBreakingImpulseThreshold(threshold);
    for (int i = 0; i < 10; ++i) world.Step();
    return joint->isEnabled();
  };
  const btScalar weight = 2 * kGravity * kTimeStep;  // impulse of one step
  EXPECT_TRUE(enabled_after(btScalar(1.1) * weight));
  // p2p rows are x, y, z and only the last may break it, so pull the box aside for a load there
  bullet::ConstraintSolver solver;
  World world(&solver);
  btTypedConstraint* const joint = HangBox(&world);
  joint->setBreakingImpulseThreshold(btScalar(0.5));
  world.dynamic_bodies()[0]->applyCentralImpulse({0, 0, 20});
  for (int i = 0; i < 10; ++i) world.Step();
  EXPECT_FALSE(joint->isEnabled());
}

// What a metre is, and so what is slow, is told by the gravity of most bodies. A missile far away
// with one of its own, added first, had loosened the solver for all.
TEST(Features, GravityOfOneBodyChangesNothingForOthers) {
  const auto speeds_beside = [](btScalar gravity) {
    bullet::ConstraintSolver solver;
    World world(&solver);
    btRigidBody* const missile =
        world.AddSphere(1, {.mass = 1, .pose = At(500, 500, 0), .surface = {}});
    world.AddGround(10);
    std::vector<btRigidBody*> boxes;
    for (int i = 0; i < 5; ++i) {
      boxes.push_back(world.AddBox(btVector3(1, 1, 1) / 2,
                                   {.mass = 1, .pose = At(0, btScalar(i) + btScalar(0.5), 0)}));
    }
    missile->setGravity({0, -gravity, 0});
    std::vector<btScalar> speeds;
    for (int step = 0; step < 60; ++step) {
      world.Step();
      for (const btRigidBody* const box : boxes) speeds.push_back(box->getLinearVelocity().y());
    }
    return speeds;
  };
  EXPECT_EQ(speeds_beside(10'000), speeds_beside(kGravity));
}

TEST(Features, NumbersThatMakeNoSenseAreTakenAsZero) {
  bullet::ConstraintSolver solver;
  World world(&solver);
  world.AddGround(10);
  btRigidBody* const ball = world.AddSphere(1, {.mass = 1, .pose = At(0, 3, 0), .surface = {}});
  btRigidBody* const other = world.AddSphere(1, {.mass = 1, .pose = At(5, 1, 0), .surface = {}});
  world.solver_info().m_restitutionVelocityThreshold = -1;
  world.solver_info().m_globalCfm = btScalar(-1e-3);
  // a joint of a body with itself, and one that breaks at once
  world.AddJoint(std::make_unique<btPoint2PointConstraint>(*ball, *ball, btVector3(0, 0, 0),
                                                           btVector3(1, 0, 0)),
                 ConnectedBodies::kCollide);
  btTypedConstraint* const weak =
      world.AddJoint(std::make_unique<btPoint2PointConstraint>(*other, btVector3(0, 1, 0)),
                     ConnectedBodies::kCollide);
  weak->setBreakingImpulseThreshold(-1);
  for (int i = 0; i < 90; ++i) {
    world.Step();
    ASSERT_TRUE(solver.report().ok()) << Describe(solver.report());
    ASSERT_FALSE(solver.fell_back());
  }
  EXPECT_NEAR(ball->getCenterOfMassPosition().y(), 1, 0.01);
  EXPECT_FALSE(weak->isEnabled());
}

TEST(Features, ADisabledJointHoldsNothing) {
  bullet::ConstraintSolver solver;
  World world(&solver);
  HangBox(&world)->setEnabled(false);
  for (int i = 0; i < 30; ++i) world.Step();

  EXPECT_LT(world.dynamic_bodies()[0]->getLinearVelocity().y(), -4);
}

TEST(Features, BodiesWithoutContactsFall) {
  bullet::ConstraintSolver solver;
  World world(&solver);
  world.AddSphere(1, {.mass = 1, .pose = At(0, 100, 0), .surface = {}});
  for (int i = 0; i < 60; ++i) world.Step();

  EXPECT_NEAR(world.dynamic_bodies()[0]->getLinearVelocity().y(), -kGravity, 1e-3);
  EXPECT_TRUE(solver.report().ok());
}

TEST(Features, AnEmptyWorldIsNoError) {
  bullet::ConstraintSolver solver;
  World world(&solver);
  world.Step();
  EXPECT_TRUE(solver.report().ok());
}

TEST(Features, ASubstepWithoutBodiesHasAProblemWithoutRows) {
  for (bullet::Mode mode : {bullet::Mode::kFast, bullet::Mode::kReference}) {
    bullet::ConstraintSolver solver({}, {.mode = mode});
    World world(&solver);
    HangBox(&world);
    world.Step();
    EXPECT_EQ(solver.problem().rows.size() + solver.problem().joint_rows.size(), 3u);
    const btContactSolverInfo& info = world.solver_info();
    solver.solveGroup(nullptr, 0, nullptr, 0, nullptr, 0, info, nullptr, nullptr);
    EXPECT_TRUE(solver.report().ok());
    EXPECT_TRUE(solver.problem().bodies.empty());
    EXPECT_TRUE(solver.impulses().empty());
  }
}

TEST(Features, SweepsFollowTheIterationsOfTheWorldAndOfTheJoint) {
  bullet::ConstraintSolver solver;
  World world(&solver);
  world.solver_info().m_numIterations = 7;
  world.AddGround(10);
  world.AddBox(btVector3(1, 1, 1) / 2,
               {.mass = 1, .pose = At(0, btScalar(0.49), 0), .surface = {}});
  world.Step();
  EXPECT_LE(solver.report().sweeps, 7);

  // two links, so that a few sweeps do not solve it
  btTypedConstraint* const upper = HangBox(&world);
  btRigidBody* const below =
      world.AddBox(btVector3(1, 1, 1) / 4, {.mass = 9, .pose = At(0, 3, 0), .surface = {}});
  btTypedConstraint* const lower =
      world.AddJoint(std::make_unique<btPoint2PointConstraint>(
                         upper->getRigidBodyA(), *below, btVector3(0, -1, 0), btVector3(0, 1, 0)),
                     ConnectedBodies::kCollide);
  solver.settings().k_sm = 0;
  world.Step();
  EXPECT_EQ(solver.report().sweeps, 7);
  upper->setOverrideNumSolverIterations(30);
  lower->setOverrideNumSolverIterations(30);
  world.Step();
  EXPECT_EQ(solver.report().sweeps, 30);
}

TEST(Features, AResidualThresholdEndsTheSweepsEarly) {
  bullet::ConstraintSolver solver(Settings{.k_sm = 0});
  World world(&solver);
  world.solver_info().m_numIterations = 1000;
  world.solver_info().m_leastSquaresResidualThreshold = btScalar(1e-4);
  world.AddGround(10);
  for (int i = 0; i < 5; ++i) {
    world.AddBox(btVector3(1, 1, 1) / 2,
                 {.mass = 1, .pose = At(0, btScalar(0.5) + btScalar(i), 0), .surface = {}});
  }
  world.Step();
  EXPECT_EQ(solver.report().stop, StopReason::kStationary);
  EXPECT_LT(solver.report().sweeps, 1000);
  EXPECT_LE(solver.report().residual_max, 0.1);
}

TEST(Features, KinematicBodiesAreNotMovedWhateverTheirMass) {
  bullet::ConstraintSolver solver;
  World world(&solver);
  btRigidBody* const table =
      world.AddBox(btVector3(2, 1, 2), {.mass = 5, .pose = At(0, 0, 0), .surface = {}});
  world.bullet()->removeRigidBody(table);
  table->setCollisionFlags(table->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  world.bullet()->addRigidBody(table);
  btRigidBody* const box = world.AddBox(
      btVector3(1, 1, 1) / 2, {.mass = 1, .pose = At(0, btScalar(1.5), 0), .surface = {}});
  for (int i = 0; i < 60; ++i) world.Step();

  EXPECT_EQ(table->getLinearVelocity().length2(), 0);
  EXPECT_NEAR(box->getCenterOfMassPosition().y(), 1.5, 0.02);
}

TEST(Features, DeepPenetrationIsPushedOutWithoutSpeed) {
  bullet::ConstraintSolver solver;
  World world(&solver);
  world.AddGround(10);
  btRigidBody* const box = world.AddBox(
      btVector3(1, 1, 1) / 2, {.mass = 1, .pose = At(0, btScalar(0.4), 0), .surface = {}});
  world.Step();  // 0.1 m deep: beyond the threshold of the split impulse

  EXPECT_GT(box->getCenterOfMassPosition().y(), 0.405);
  EXPECT_LT(box->getLinearVelocity().y(), 0.01);
}

TEST(Features, APushThatIsNoNumberMovesNothing) {
  bullet::ConstraintSolver solver;
  World world(&solver);
  world.AddGround(10);
  btRigidBody* const box = world.AddBox(
      btVector3(1, 1, 1) / 2, {.mass = 1, .pose = At(0, btScalar(0.4), 0), .surface = {}});
  world.solver_info().m_erp2 = std::numeric_limits<btScalar>::quiet_NaN();
  world.Step();

  EXPECT_TRUE(solver.report().ok());
  EXPECT_NEAR(box->getCenterOfMassPosition().y(), 0.4, 1e-6);
}

TEST(Features, RollingFrictionStopsABall) {
  const auto speed_after = [](btScalar rolling_friction) {
    bullet::ConstraintSolver solver;
    World world(&solver);
    btRigidBody* const ground = world.AddGround(50);
    ground->setRollingFriction(rolling_friction);
    btRigidBody* const ball =
        world.AddSphere(btScalar(0.5), {.mass = 1,
                                        .pose = At(0, btScalar(0.5), 0),
                                        .surface = {.rolling_friction = rolling_friction}});
    ball->setLinearVelocity({2, 0, 0});
    for (int i = 0; i < 180; ++i) world.Step();
    return ball->getLinearVelocity().length();
  };
  EXPECT_GT(speed_after(0), 1);
  EXPECT_LT(speed_after(btScalar(0.5)), 0.01);
}

TEST(Features, WhatOnlyTheReferenceModeCanTakeIsNamedAsWell) {
  bullet::ConstraintSolver solver;
  World world(&solver);
  world.AddGround(10);
  world.AddBox(btVector3(1, 1, 1) / 2, {.mass = 1, .pose = At(0, btScalar(0.49), 0)});
  world.dynamic_bodies()[0]->setFriction(std::numeric_limits<btScalar>::quiet_NaN());
  for (int i = 0; i < 3; ++i) world.Step();
  EXPECT_TRUE(solver.fell_back());
  EXPECT_NE(solver.complaint().find("friction"), std::string::npos) << solver.complaint();
  world.dynamic_bodies()[0]->setFriction(1);
  // points keep the friction that they were found with
  world.dynamic_bodies()[0]->translate({0, 5, 0});
  world.Step();
  world.Step();
  EXPECT_EQ(solver.complaint(), "");
}

TEST(Features, ASubstepEndsOnce) {
  bullet::ConstraintSolver solver;
  World world(&solver);
  HangBox(&world);
  world.Step();
  btRigidBody* const box = world.dynamic_bodies()[0];
  box->applyCentralForce({0, -100, 0});
  const btVector3 velocity = box->getLinearVelocity();
  solver.allSolved(world.solver_info(), nullptr);
  EXPECT_EQ(box->getLinearVelocity(), velocity);
}

// A balloon, or a planet's own gravity, says nothing of the units of the world.
TEST(Features, ABodyThatHardlyFallsDoesNotSayHowLongAMetreIs) {
  const auto hash_with = [](double units) {
    Settings settings;
    settings.tuning.units_per_metre = units;
    bullet::ConstraintSolver solver(settings);
    World world(&solver);
    btRigidBody* const balloon =
        world.AddBox(btVector3(1, 1, 1) / 4, {.mass = 1, .pose = At(0, 50, 0)});
    balloon->setGravity({0, btScalar(-0.05), 0});
    HangBox(&world)->getRigidBodyA().setAngularVelocity({3, 0, 5});
    for (int i = 0; i < 60; ++i) world.Step();
    return bench::StateHash(world);
  };
  EXPECT_EQ(hash_with(0), hash_with(1));
  EXPECT_NE(hash_with(1.0 / 128), hash_with(1));
}

TEST(Features, ContactsHaveTwoDirectionsOfFrictionUnlessAskedForOne) {
  const auto directions = [](const Settings& settings, const bullet::Options& options, int mode) {
    bullet::ConstraintSolver solver(settings, options);
    World world(&solver);
    world.AddGround(10);
    world.AddBox(btVector3(1, 1, 1) / 2, {.mass = 1, .pose = At(0, btScalar(0.49), 0)});
    world.solver_info().m_solverMode = mode;
    world.Step();
    EXPECT_EQ(solver.problem().manifolds.size(), 1u);
    return static_cast<int>(solver.problem().manifolds[0].tangents);
  };
  const int one = btContactSolverInfo().m_solverMode, two = one | SOLVER_USE_2_FRICTION_DIRECTIONS;
  EXPECT_EQ(directions({}, {}, one), 2);
  EXPECT_EQ(directions({}, {}, two), 2);
  EXPECT_EQ(directions({}, {.two_friction_directions = false}, one), 1);
  EXPECT_EQ(directions({}, {.two_friction_directions = false}, two), 2);
  EXPECT_EQ(directions({.steps = false}, {}, one), 1) << "sweeps as Bullet's";
  EXPECT_EQ(directions({}, {}, one | SOLVER_ENABLE_FRICTION_DIRECTION_CACHING), 1);
}

// A joint with a lever of 1e-28 m on a body that may turn but not move: to answer it would have to
// turn by 1e40 rad/s, which Bullet's floats do not hold.
TEST(Features, AJointThatMovesABodyByNothingButRoundingLeavesItAlone) {
  bullet::ConstraintSolver solver({.path = Path::kReference});
  World world(&solver);
  btPoint2PointConstraint* const joint = HangBox(&world);
  joint->getRigidBodyA().setLinearFactor({0, 0, 0});
  joint->setPivotA({0, btScalar(1e-28), 0});
  joint->setPivotB({btScalar(1e20), 5, 0});
  world.Step();
  EXPECT_TRUE(solver.report().ok());
  EXPECT_FALSE(solver.fell_back());
  EXPECT_EQ(joint->getRigidBodyA().getAngularVelocity(), btVector3(0, 0, 0));
}

/// Draws nothing, and keeps what Bullet calls warnings.
class Warnings : public btIDebugDraw {
 public:
  std::vector<std::string> said;

  void reportErrorWarning(const char* text) override { said.emplace_back(text); }
  void drawLine(const btVector3&, const btVector3&, const btVector3&) override {}
  void drawContactPoint(const btVector3&, const btVector3&, btScalar, int,
                        const btVector3&) override {}
  void draw3dText(const btVector3&, const char*) override {}
  void setDebugMode(int) override {}
  int getDebugMode() const override { return 0; }
};

// The world goes on with Bullet's iteration, and everybody who asks is told why.
TEST(Features, ABadSettingIsNamed) {
  for (const bullet::Mode mode : {bullet::Mode::kFast, bullet::Mode::kReference}) {
    bullet::ConstraintSolver solver({}, {.mode = mode});
    World world(&solver);
    Warnings warnings;
    world.bullet()->setDebugDrawer(&warnings);
    world.AddGround(10);
    const btRigidBody* const box = world.AddBox(
        btVector3(1, 1, 1) / 2, {.mass = 1, .pose = At(0, btScalar(0.49), 0), .surface = {}});
    world.Step();
    EXPECT_TRUE(solver.report().ok());
    EXPECT_GT(solver.report().elapsed.count(), 0);
    EXPECT_EQ(solver.complaint(), "");

    solver.settings().threads = 0;
    for (int i = 0; i < 30; ++i) world.Step();
    EXPECT_EQ(solver.report().status, Status::kBadSettings);
    EXPECT_TRUE(solver.fell_back());
    const std::string expected = "threads is 0, must be 1 to 1024";
    EXPECT_EQ(solver.complaint(), expected);
    EXPECT_EQ(warnings.said, std::vector{"cairn: " + expected});  // once
    EXPECT_NEAR(box->getWorldTransform().getOrigin().y(), 0.5, 0.02);

    // without a budget it has no effect, and is refused all the same
    solver.settings() = Settings{.tolerance = -1};
    world.Step();
    EXPECT_EQ(solver.complaint(), "tolerance is -1, must be 0 or more");
    solver.settings() = Settings{};
    world.Step();
    EXPECT_FALSE(solver.fell_back());
    EXPECT_EQ(solver.complaint(), "");
    EXPECT_EQ(warnings.said.size(), 2u);
  }
}

/// Sweeps of the first substep of a stack of three boxes.
int SweepsOf(const Settings& settings, bullet::Effort effort) {
  bullet::ConstraintSolver solver(settings, {.effort = effort});
  World world(&solver);
  world.AddGround(10);
  for (int i = 0; i < 3; ++i) {
    world.AddBox(btVector3(1, 1, 1) / 2,
                 {.mass = 1, .pose = At(0, btScalar(0.49 + i), 0), .surface = {}});
  }
  world.solver_info().m_numIterations = 7;
  world.Step();
  return solver.report().sweeps;
}

TEST(Features, EffortSaysWhoseNumbersAreRead) {
  Settings few{.steps = false, .max_sweeps = 3, .tolerance = 0};
  EXPECT_GE(SweepsOf(few, bullet::Effort::kAuto), 7);
  EXPECT_GE(SweepsOf(few, bullet::Effort::kIterations), 7);
  EXPECT_EQ(SweepsOf(few, bullet::Effort::kSettings), 3);
  few.budget = Budget::Work(1'000'000'000);
  EXPECT_EQ(SweepsOf(few, bullet::Effort::kAuto), 3);
  EXPECT_EQ(SweepsOf(few, bullet::Effort::kSettings), 3);
  EXPECT_GE(SweepsOf(few, bullet::Effort::kIterations), 7);
  few.budget = Budget::Work(1);
  EXPECT_EQ(SweepsOf(few, bullet::Effort::kIterations), 1);  // Tuning::min_sweeps
}

TEST(Features, ABudgetOfTimeIsForTheWholeSubstepAndStopsTheSweeps) {
  bullet::ConstraintSolver solver(Settings{.budget = Budget::Time(std::chrono::nanoseconds(0))});
  World world(&solver);
  world.AddGround(10);
  world.AddBox(btVector3(1, 1, 1) / 2,
               {.mass = 1, .pose = At(0, btScalar(0.49), 0), .surface = {}});
  world.Step();
  EXPECT_EQ(solver.report().stop, StopReason::kTimeSpent);
  EXPECT_EQ(solver.report().sweeps, Tuning::kLateSweeps);
}

/// A pile after some steps under a budget of time by a clock of the test's own.
struct TimedPile {
  std::uint64_t hash = 0;
  StopReason stop = StopReason::kNotStarted;  ///< of the last step
};

TimedPile StepTimedPile(const ScriptedClock& clock, bullet::Mode mode) {
  Settings settings;
  settings.budget = Budget::Time(std::chrono::milliseconds(1));
  settings.tuning.clock = &clock;
  settings.tolerance = 0;
  bullet::Options options;
  options.mode = mode;
  bullet::ConstraintSolver solver(settings, options);
  World world(&solver);
  world.AddGround(10);
  for (int i = 0; i < 12; ++i) {
    world.AddBox(btVector3(1, 1, 1) / 2,
                 {.mass = 1, .pose = At(0, btScalar(0.5) + btScalar(i), 0), .surface = {}});
  }
  for (int i = 0; i < 20; ++i) {
    world.Step();
    EXPECT_TRUE(solver.report().ok());
    EXPECT_FALSE(solver.fell_back());
    EXPECT_GE(solver.times().write, std::chrono::nanoseconds(0));
  }
  return {bench::StateHash(world), solver.report().stop};
}

constexpr bullet::Mode kModes[] = {bullet::Mode::kFast, bullet::Mode::kReference};

// Where the clock is the same, so are the bits.
TEST(Features, ABudgetOfTimeGoesByTheClockOfTheSettings) {
  using std::chrono::microseconds;
  for (const bullet::Mode mode : kModes) {
    const TimedPile first = StepTimedPile(TickingClock(microseconds(10)), mode);
    EXPECT_EQ(first.stop, StopReason::kTimeSpent);
    EXPECT_EQ(StepTimedPile(TickingClock(microseconds(10)), mode).hash, first.hash);
    EXPECT_NE(StepTimedPile(TickingClock(microseconds(50)), mode).hash, first.hash);
  }
}

TEST(Features, AClockThatJumpsBackOrStandsStillDoesNoHarm) {
  using std::chrono::nanoseconds;
  for (const bullet::Mode mode : kModes) {
    EXPECT_NE(StepTimedPile(TickingClock(nanoseconds(0)), mode).stop, StopReason::kTimeSpent);
    for (const int every : {2, 7, 50}) {
      StepTimedPile(ScriptedClock([every](int look) -> nanoseconds {
                      return look % every == 0 ? nanoseconds(-std::chrono::minutes(1))
                                               : nanoseconds(std::chrono::microseconds(20));
                    }),
                    mode);
    }
    // once, and budgets are kept afterwards
    const ScriptedClock once([](int look) -> nanoseconds {
      return look == 300 ? nanoseconds(-std::chrono::hours(1))
                         : nanoseconds(std::chrono::microseconds(20));
    });
    EXPECT_EQ(StepTimedPile(once, mode).stop, StopReason::kTimeSpent);
    EXPECT_LT(once.looks(), 20 * 400);
  }
}

TEST(Features, ABudgetOfAllTheTimeThereIsEndsNothing) {
  for (bullet::Mode mode : {bullet::Mode::kFast, bullet::Mode::kReference}) {
    Settings settings;
    settings.budget = Budget::Time(std::chrono::nanoseconds::max());
    settings.max_sweeps = 30;
    settings.tolerance = 0;
    settings.k_sm = 0;
    bullet::Options options;
    options.mode = mode;
    bullet::ConstraintSolver solver(settings, options);
    World world(&solver);
    HangBox(&world);
    world.Step();
    EXPECT_NE(solver.report().stop, StopReason::kTimeSpent);
    EXPECT_GT(solver.report().sweeps, 1);
  }
}

TEST(Features, ABudgetOfWorkGivesTheSameBitsTwice) {
  const auto hash = [] {
    bullet::ConstraintSolver solver(Settings{.budget = Budget::Work(20000)});
    World world(&solver);
    world.AddGround(10);
    for (int i = 0; i < 20; ++i) {
      world.AddBox(btVector3(1, 1, 1) / 2,
                   {.mass = 1, .pose = At(0, btScalar(0.5) + btScalar(i), 0), .surface = {}});
    }
    for (int i = 0; i < 60; ++i) world.Step();
    return bench::StateHash(world);
  };
  EXPECT_EQ(hash(), hash());
}

TEST(Features, ResetForgetsWhatWasLearnt) {
  const auto run = [](bullet::ConstraintSolver* solver) {
    World world(solver);
    world.AddGround(10);
    for (int i = 0; i < 10; ++i) {
      world.AddBox(btVector3(1, 1, 1) / 2, {.mass = i == 9 ? btScalar(100) : btScalar(1),
                                            .pose = At(0, btScalar(0.5) + btScalar(i), 0),
                                            .surface = {}});
    }
    for (int i = 0; i < 60; ++i) world.Step();
    return bench::StateHash(world);
  };
  bullet::ConstraintSolver solver;
  const auto fresh = run(&solver);
  solver.reset();
  EXPECT_EQ(run(&solver), fresh);
}

TEST(Features, SolvesAtOnceForCallersWithoutABracket) {
  bullet::ConstraintSolver solver;
  btRigidBody body(btRigidBody::btRigidBodyConstructionInfo(1, nullptr, nullptr));
  body.applyCentralForce({60, 0, 0});
  btCollisionObject* object = &body;
  btContactSolverInfo info;
  info.m_timeStep = kTimeStep;
  solver.solveGroup(&object, 1, nullptr, 0, nullptr, 0, info, nullptr, nullptr);
  EXPECT_NEAR(body.getLinearVelocity().x(), 1, 1e-5);
  EXPECT_LT(body.getCompanionId(), 0);
}

TEST(Features, WorksWithIslandsSwitchedOff) {
  bullet::ConstraintSolver solver;
  World world(&solver);
  world.bullet()->getSimulationIslandManager()->setSplitIslands(false);
  world.AddGround(10);
  btRigidBody* const box = world.AddBox(
      btVector3(1, 1, 1) / 2, {.mass = 1, .pose = At(0, btScalar(0.5), 0), .surface = {}});
  for (int i = 0; i < 60; ++i) world.Step();
  EXPECT_NEAR(box->getCenterOfMassPosition().y(), 0.5, 0.01);
}

TEST(Features, IsTakenForASequentialImpulseSolver) {
  bullet::ConstraintSolver solver;
  EXPECT_EQ(solver.getSolverType(), BT_SEQUENTIAL_IMPULSE_SOLVER);
}

// Debug builds of games let exceptions of floating point end the program.
TEST(Features, RaisesNoExceptionsOfFloatingPoint) {
  constexpr int kExceptions = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;
  for (const std::string_view name : SceneNames()) {
    bullet::ConstraintSolver solver;
    SceneWorld scene(name, &solver);
    int raised = 0;
    for (int frame = 0; frame < 30; ++frame) {
      std::feclearexcept(kExceptions);
      scene.Step(1);
      raised |= std::fetestexcept(kExceptions);
    }
    EXPECT_EQ(raised, 0) << name;
  }
}

}  // namespace
}  // namespace cairn::test
