// SPDX-License-Identifier: MIT
// Settings::substeps and Settings::relax in worlds of Bullet.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "cairn/bullet/constraint_solver.h"
#include "scenes/facts.h"
#include "scenes/world.h"
#include "tests/bullet_adapter/scene_world.h"

namespace cairn::test {
namespace {

using bench::At;
using bench::World;

constexpr double kGravityInDoubles = 9.81, kStep = 1.0 / 60;

Settings Parts(int parts) {
  Settings settings;
  settings.substeps = parts;
  return settings;
}

double HeightOf(const btRigidBody* body) {
  return static_cast<double>(body->getCenterOfMassPosition().y());
}

// After t = k h in parts of h / n: y = -g t^2 / 2 (1 + 1 / (k n)).
TEST(SubstepsInBullet, FallAsInSoManySteps) {
  for (const int parts : {1, 4}) {
    bullet::ConstraintSolver solver(Parts(parts));
    World world(&solver);
    btRigidBody* const ball = world.AddSphere(btScalar(0.5), {.mass = 3, .pose = At(0, 0, 0)});
    ball->setLinearVelocity(btVector3(2, 0, 0));
    for (int k = 0; k < 30; ++k) world.Step();
    const double fallen = kGravityInDoubles * 0.5 * 0.5 / 2 * (1 + 1.0 / (30 * parts));
    EXPECT_NEAR(HeightOf(ball), -fallen, 1e-4);
    EXPECT_NEAR(static_cast<double>(ball->getLinearVelocity().y()), -kGravityInDoubles * 0.5, 1e-4);
    EXPECT_NEAR(static_cast<double>(ball->getCenterOfMassPosition().x()), 1, 1e-5);
  }
}

TEST(SubstepsInBullet, BounceAsHighAsTheyFell) {
  bullet::ConstraintSolver solver(Parts(4));
  World world(&solver);
  const bench::Surface rubber{.restitution = 1};
  world.AddBox(btVector3(5, 1, 5), {.pose = At(0, -1, 0), .surface = rubber});
  btRigidBody* const ball =
      world.AddSphere(btScalar(0.25), {.mass = 1, .pose = At(0, 2, 0), .surface = rubber});
  double lowest = 2, apex = 0;
  for (int k = 0; k < 90; ++k) {
    world.Step();
    lowest = std::min(lowest, HeightOf(ball));
    if (k > 45) apex = std::max(apex, HeightOf(ball));
  }
  EXPECT_LT(lowest, 0.5) << "did not get there";
  // a step of its speed at the ground, 6 m/s, is 3 % of its energy
  EXPECT_NEAR(apex, 2, 0.1);
}

TEST(SubstepsInBullet, LetTowersStand) {
  for (const int parts : {2, 4}) {
    bullet::ConstraintSolver solver(Parts(parts));
    SceneWorld tower("tower", &solver);
    const double built = bench::TopHeight(tower.world());
    tower.Step(300);
    EXPECT_NEAR(bench::TopHeight(tower.world()), built, 0.02) << parts;
  }
}

// Friction 0.5 on 0.5 is 0.25: v^2 / (2 mu g) to a stop from 3 m/s.
TEST(SubstepsInBullet, SlideAsFarAsFrictionLets) {
  bullet::ConstraintSolver solver(Parts(3));
  World world(&solver);
  world.AddGround(20);
  btRigidBody* const box = world.AddBox(btVector3(btScalar(0.5), btScalar(0.1), btScalar(0.5)),
                                        {.mass = 4, .pose = At(0, btScalar(0.1), 0)});
  box->setLinearVelocity(btVector3(3, 0, 0));
  for (int k = 0; k < 150; ++k) world.Step();
  EXPECT_NEAR(static_cast<double>(box->getCenterOfMassPosition().x()),
              9 / (2 * 0.25 * kGravityInDoubles), 0.03);
}

// A ball of 50 kg hangs on a joint: feedback is its weight, and the joint breaks where that is
// above its threshold.
TEST(SubstepsInBullet, FeelAndBreakAsInOneStep) {
  for (const double share : {0.9, 1.1}) {
    bullet::ConstraintSolver solver(Parts(4));
    World world(&solver);
    btRigidBody* const ball = world.AddSphere(btScalar(0.5), {.mass = 50, .pose = At(0, 5, 0)});
    auto* const pin = world.AddJoint(
        std::make_unique<btPoint2PointConstraint>(*ball, btVector3(0, btScalar(0.5), 0)),
        bench::ConnectedBodies::kPassThrough);
    btJointFeedback feedback;
    pin->setJointFeedback(&feedback);
    pin->setBreakingImpulseThreshold(btScalar(share * 50 * kGravityInDoubles * kStep));
    for (int k = 0; k < 60 && pin->isEnabled(); ++k) world.Step();
    EXPECT_EQ(pin->isEnabled(), share > 1);
    if (share > 1) {
      EXPECT_NEAR(static_cast<double>(feedback.m_appliedForceBodyA.y()), 50 * kGravityInDoubles, 1);
      EXPECT_NEAR(HeightOf(ball), 5, 1e-3);
    }
  }
}

TEST(SubstepsInBullet, CarryWhatLiesOnAMovingFloor) {
  bullet::ConstraintSolver solver(Parts(4));
  World world(&solver);
  btRigidBody* const floor =
      world.AddBox(btVector3(3, btScalar(0.5), 3), {.pose = At(0, btScalar(-0.5), 0)});
  floor->setCollisionFlags(floor->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  floor->setActivationState(DISABLE_DEACTIVATION);
  btRigidBody* const box = world.AddBox(btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5)),
                                        {.mass = 2, .pose = At(0, btScalar(0.5), 0)});
  for (int k = 1; k <= 60; ++k) {
    // up at 1 m/s
    btTransform pose = floor->getWorldTransform();
    pose.setOrigin(btVector3(0, btScalar(-0.5 + k * kStep), 0));
    floor->setInterpolationWorldTransform(floor->getWorldTransform());
    floor->setLinearVelocity(btVector3(0, 1, 0));
    floor->setWorldTransform(pose);
    world.Step();
  }
  EXPECT_NEAR(HeightOf(box), 1.5, 0.06);
}

// A light chain let go level: what it costs a single step is that its arms turn.
TEST(SubstepsInBullet, HoldWhips) {
  const auto gap = [](int parts) {
    bullet::ConstraintSolver solver(Parts(parts));
    World world(&solver);
    btRigidBody* previous = nullptr;
    for (int i = 0; i < 8; ++i) {
      btRigidBody* const link =
          world.AddBox(btVector3(btScalar(0.25), btScalar(0.05), btScalar(0.05)),
                       {.mass = 1, .pose = At(btScalar(0.25 + 0.5 * i), 0, 0)});
      const btVector3 left(btScalar(-0.25), 0, 0), right(btScalar(0.25), 0, 0);
      world.AddJoint(previous == nullptr
                         ? std::make_unique<btPoint2PointConstraint>(*link, left)
                         : std::make_unique<btPoint2PointConstraint>(*link, *previous, left, right),
                     bench::ConnectedBodies::kPassThrough);
      previous = link;
    }
    double largest = 0;
    for (int k = 0; k < 180; ++k) {
      world.Step();
      largest = std::max(largest, bench::LargestJointGap(world));
    }
    return largest;
  };
  const double once = gap(1), four = gap(4);
  EXPECT_GT(once, 0.02) << "not a hard case";
  EXPECT_LT(four, once / 3);
}

TEST(SubstepsInBullet, LeaveWhatBulletDoesNotMove) {
  for (const bool relax : {false, true}) {
    Settings settings = Parts(relax ? 1 : 4);
    settings.relax = relax;
    bullet::ConstraintSolver solver(settings);
    World world(&solver);
    const auto add = [&](btScalar y) {
      return world.AddBox(btVector3(1, 1, 1) / 4, {.mass = 1, .pose = At(0, y, 0)});
    };
    btRigidBody *const held = add(5), *const hangs = add(4);
    held->forceActivationState(DISABLE_SIMULATION);
    world.AddJoint(std::make_unique<btPoint2PointConstraint>(*held, *hangs, btVector3(0, -1, 0),
                                                             btVector3(0, 0, 0)),
                   bench::ConnectedBodies::kPassThrough);
    for (int i = 0; i < 60; ++i) world.Step();
    EXPECT_EQ(HeightOf(held), 5);
  }
}

// In a mode where Bullet moves bodies there is one step.
TEST(SubstepsInBullet, AreNotMadeWhereBulletReads) {
  bullet::ConstraintSolver once({}, {.mode = bullet::Mode::kReference});
  bullet::ConstraintSolver parts(Parts(4), {.mode = bullet::Mode::kReference});
  SceneWorld a("pyramid", &once), b("pyramid", &parts);
  a.Step(20);
  b.Step(20);
  EXPECT_EQ(bench::StateHash(a.world()), bench::StateHash(b.world()));
}

TEST(SubstepsInBullet, KeepEveryScene) {
  for (const std::string_view name : {"ragdolls", "bridge", "car", "wrecking-ball", "pyramid"}) {
    bullet::ConstraintSolver solver(Parts(3));
    SceneWorld world(name, &solver);
    world.Step(120);
    EXPECT_TRUE(solver.report().ok()) << name;
    EXPECT_FALSE(solver.fell_back()) << name;
    EXPECT_LT(bench::LargestSpeed(world.world()), 40) << name;
  }
}

// A box 20 cm deep in the floor, and nothing that keeps its push apart: Settings::relax does.
TEST(RelaxationInBullet, TakesBackDepthAndLeavesNoSpeed) {
  for (const bool relax : {false, true}) {
    Settings settings;
    settings.relax = relax;
    bullet::ConstraintSolver solver(settings);
    World world(&solver);
    world.solver_info().m_splitImpulse = 0;
    world.AddGround(20);
    const btScalar half(0.5);
    btRigidBody* const box =
        world.AddBox(btVector3(half, half, half), {.mass = 4, .pose = At(0, btScalar(0.3), 0)});
    double fastest = 0;
    for (int k = 0; k < 120; ++k) {
      world.Step();
      fastest = std::max(fastest, static_cast<double>(box->getLinearVelocity().y()));
    }
    EXPECT_NEAR(HeightOf(box), 0.5, 0.02) << relax;
    if (relax) {
      EXPECT_LT(fastest, 0.05);
    } else {
      EXPECT_GT(fastest, 0.5) << "nothing to take back";
    }
  }
}

// A box that hangs 20 cm below its pin.
TEST(RelaxationInBullet, ClosesJointsAndLeavesNoSpeed) {
  for (const bool relax : {false, true}) {
    Settings settings;
    settings.relax = relax;
    bullet::ConstraintSolver solver(settings);
    World world(&solver);
    const btScalar half(0.5);
    btRigidBody* const box =
        world.AddBox(btVector3(half, half, half), {.mass = 4, .pose = At(0, 1, 0)});
    auto pin = std::make_unique<btPoint2PointConstraint>(*box, btVector3(0, half, 0));
    pin->setPivotB(btVector3(0, btScalar(1.7), 0));
    world.AddJoint(std::move(pin), bench::ConnectedBodies::kCollide);
    double fastest = 0;
    for (int k = 0; k < 120; ++k) {
      world.Step();
      fastest = std::max(fastest, static_cast<double>(box->getLinearVelocity().y()));
    }
    EXPECT_NEAR(HeightOf(box), 1.2, 0.001) << relax;
    if (relax) {
      EXPECT_LT(fastest, 0.01);
    } else {
      EXPECT_GT(fastest, 0.5) << "nothing to take back";
    }
  }
}

}  // namespace
}  // namespace cairn::test
