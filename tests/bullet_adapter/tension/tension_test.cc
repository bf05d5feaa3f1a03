// SPDX-License-Identifier: MIT
// Heavy loads on light jointed bodies in worlds of Bullet: Options::geometric_stiffness.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string_view>
#include <vector>

#include "cairn/bullet/constraint_solver.h"
#include "cairn/detail/stiffness.h"
#include "scenes/facts.h"
#include "scenes/world.h"
#include "tests/bullet_adapter/scene_world.h"

namespace cairn::test {
namespace {

using bench::At;
using bench::World;

constexpr double kGravity = 9.81, kStep = 1.0 / 60;
constexpr int kLinks = 6;

/// Links of 1 kg and 1 m that hang from the world, and a load at their end.
struct LoadedChain {
  bullet::ConstraintSolver solver;
  World world{&solver};
  std::vector<btRigidBody*> bodies;
  std::vector<btTypedConstraint*> joints;  ///< the first holds the chain, the last the load
  btJointFeedback feedback;                ///< of the first
  double load;

  /// @p links  half the length of their shapes [m]; connected bodies that collide want less than
  /// 0.5
  explicit LoadedChain(double load_, const Settings& settings = {},
                       const bullet::Options& options = {}, double tilt = 0,
                       btScalar links = btScalar(0.5),
                       bench::ConnectedBodies connected = bench::ConnectedBodies::kPassThrough)
      : solver(settings, options), load(load_) {
    const btQuaternion turn(btVector3(0, 0, 1), btScalar(tilt));
    const btTransform frame(turn, btVector3(0, 20, 0));
    const btVector3 half(btScalar(0.1), links, btScalar(0.1)), up(0, btScalar(0.5), 0);
    for (int i = 0; i <= kLinks; ++i) {
      const btTransform pose = frame * At(0, btScalar(-0.5 - i), 0);
      btRigidBody* const body = i == kLinks
                                    ? world.AddSphere(links, {.mass = btScalar(load), .pose = pose})
                                    : world.AddBox(half, {.mass = 1, .pose = pose});
      joints.push_back(world.AddJoint(
          i == 0 ? std::make_unique<btPoint2PointConstraint>(*body, up)
                 : std::make_unique<btPoint2PointConstraint>(*body, *bodies.back(), up, -up),
          connected));
      bodies.push_back(body);
    }
    joints[0]->setJointFeedback(&feedback);
  }
  double GapOf(int steps) {
    double gap = 0;
    for (int i = 0; i < steps; ++i) {
      world.Step();
      gap = std::max(gap, bench::LargestJointGap(world));
    }
    return gap;
  }
  double MostStrain() const {
    double most = 0;
    for (const IslandReport& island : solver.report().islands) {
      most = std::max(most, island.strain);
    }
    return most;
  }
};

TEST(TensionInBullet, ChangesNoBitWhereNothingIsStrained) {
  for (const std::string_view name : {"pyramid", "tower", "wall", "door", "seesaw", "dominoes"}) {
    bullet::ConstraintSolver on, off({}, {.geometric_stiffness = false});
    SceneWorld a(name, &on), b(name, &off);
    for (int second = 0; second < 3; ++second) {
      a.Step(60);
      b.Step(60);
      EXPECT_EQ(bench::StateHash(a.world()), bench::StateHash(b.world())) << name;
    }
  }
}

TEST(TensionInBullet, IsSwitchedOffByEitherSwitch) {
  LoadedChain on(1000, {}, {}, 0.3), option(1000, {}, {.geometric_stiffness = false}, 0.3),
      setting(1000, {.geometric_stiffness = false}, {}, 0.3);
  for (LoadedChain* chain : {&on, &option, &setting}) chain->GapOf(60);
  EXPECT_GT(on.MostStrain(), 4);
  EXPECT_EQ(setting.MostStrain(), 0);
  EXPECT_EQ(bench::StateHash(option.world), bench::StateHash(setting.world));
  EXPECT_NE(bench::StateHash(option.world), bench::StateHash(on.world));
}

TEST(TensionInBullet, IsTheSameWhetherConnectedBodiesMayCollideOrNot) {
  // Bullet's addConstraint() lets them unless it is told otherwise
  LoadedChain collide(1000, {}, {}, 0.3, btScalar(0.4), bench::ConnectedBodies::kCollide),
      pass(1000, {}, {}, 0.3, btScalar(0.4), bench::ConnectedBodies::kPassThrough);
  for (LoadedChain* chain : {&collide, &pass}) chain->GapOf(60);
  EXPECT_GT(collide.MostStrain(), 4);
  EXPECT_EQ(bench::StateHash(collide.world), bench::StateHash(pass.world));
}

TEST(TensionInBullet, IsLeftAloneWhereBulletMakesTheRows) {
  const bullet::Options reference{.mode = bullet::Mode::kReference};
  bullet::Options plain = reference;
  plain.geometric_stiffness = false;
  LoadedChain on(1000, {}, reference, 0.3), off(1000, {.geometric_stiffness = false}, plain, 0.3);
  on.GapOf(30);
  off.GapOf(30);
  EXPECT_EQ(bench::StateHash(on.world), bench::StateHash(off.world));
  EXPECT_EQ(on.MostStrain(), 0);
}

/// Share of a gap of 2 cm at its top that a hanging chain takes back in a step, over Bullet's erp.
double ShareTakenBack(LoadedChain* chain) {
  for (int step = 0; step < 60; ++step) chain->world.Step();
  for (btRigidBody* const body : chain->bodies) {
    btTransform pose = body->getWorldTransform();
    pose.getOrigin() -= btVector3(0, btScalar(0.02), 0);
    body->setWorldTransform(pose);
  }
  const auto gap = [chain] { return 19.5 - chain->bodies[0]->getWorldTransform().getOrigin().y(); };
  const double before = gap();
  chain->world.Step();
  return (before - gap()) / (0.2 * before);
}

TEST(TensionInBullet, TakesGapsBackMoreSlowlyWhereItStrains) {
  LoadedChain light(10), heavy(3000), off(3000, {.geometric_stiffness = false}), breakable(3000);
  for (btTypedConstraint* const joint : breakable.joints) {
    joint->setBreakingImpulseThreshold(1e6);
  }
  EXPECT_NEAR(ShareTakenBack(&light), 1, 0.02);
  const double share = ShareTakenBack(&heavy);
  EXPECT_GT(heavy.MostStrain(), 32) << "not a hard case";
  EXPECT_NEAR(share, ShareOfErp(heavy.MostStrain()), 0.03);
  EXPECT_NEAR(ShareTakenBack(&off), 1, 0.02);
  // bounds of what may break are no motor's
  EXPECT_NEAR(ShareTakenBack(&breakable), share, 0.03);
}

TEST(TensionInBullet, LeavesWhatJointsExertAtTheWeight) {
  LoadedChain chain(1000);
  const double weight = (chain.load + kLinks) * kGravity;
  chain.GapOf(60);
  for (int i = 0; i < 120; ++i) {
    EXPECT_LT(chain.GapOf(1), 0.01);
    ASSERT_NEAR(static_cast<double>(chain.feedback.m_appliedForceBodyA.y()), weight, 0.01 * weight)
        << i;
  }
  EXPECT_GT(chain.MostStrain(), 4) << "not a hard case";
}

// Where the load is above what the last joint bears it falls, and nothing else is thrown about. A
// threshold bounds the rows of its joint, and such islands are left to sweeps, whose impulses vary.
TEST(TensionInBullet, BreaksWhereTheLoadIsTooHeavy) {
  for (const double share : {0.9, 2.0}) {
    LoadedChain chain(1000);
    chain.GapOf(60);
    chain.joints.back()->setBreakingImpulseThreshold(
        btScalar(share * chain.load * kGravity * kStep));
    chain.GapOf(60);
    EXPECT_EQ(chain.joints.back()->isEnabled(), share > 1) << share;
    if (share > 1) continue;
    EXPECT_LT(chain.bodies.back()->getLinearVelocity().y(), -7);
    for (int i = 0; i < kLinks; ++i) {
      EXPECT_LT(chain.bodies[i]->getLinearVelocity().length(), 3) << i;
    }
    for (int i = 0; i < kLinks; ++i) EXPECT_LT(bench::JointGap(*chain.joints[i]), 0.02) << i;
  }
}

// With weighed steps it takes none for a second after it woke, and opens: docs/lab/steps.md.
TEST(TensionInBullet, HoldsLoadsThatFallAsleepAndWakeUp) {
  LoadedChain chain(1000, {.step_policy = StepPolicy::kAlways});
  chain.world.LetSleep();
  for (int i = 0; i < 300 && chain.bodies[0]->isActive(); ++i) chain.world.Step();
  ASSERT_FALSE(chain.bodies[0]->isActive());
  // awake, the same push leaves as much
  LoadedChain other(1000, {.step_policy = StepPolicy::kAlways});
  other.GapOf(60);
  for (LoadedChain* of : {&chain, &other}) {
    for (btRigidBody* body : of->bodies) body->activate(true);
    of->bodies.back()->setLinearVelocity(btVector3(btScalar(0.2), 0, 0));
  }
  const double gap = chain.GapOf(240);
  EXPECT_LT(gap, 0.03);
  EXPECT_LT(gap, 1.5 * other.GapOf(240) + 0.001);
}

// A hinge with a motor at the top turns the chain about its length, another about an axis across.
TEST(TensionInBullet, HoldsWhatAMotorTurns) {
  for (const btVector3& axis : {btVector3(0, 1, 0), btVector3(0, 0, 1)}) {
    double gaps[2];
    for (const bool on : {true, false}) {
      LoadedChain chain(1000, {.step_policy = StepPolicy::kAlways}, {.geometric_stiffness = on});
      chain.world.Remove(chain.joints[0]);
      auto hinge =
          std::make_unique<btHingeConstraint>(*chain.bodies[0], btVector3(0, 0.5, 0), axis);
      hinge->enableAngularMotor(true, btScalar(0.5), btScalar(1e5));
      chain.world.AddJoint(std::move(hinge), bench::ConnectedBodies::kPassThrough);
      chain.bodies.back()->setLinearVelocity(btVector3(1, 0, 1));
      gaps[on ? 1 : 0] = chain.GapOf(240);
    }
    // 5 cm where rows that turn bodies start from all of their impulses, as others do
    EXPECT_LT(gaps[1], 0.15);
    EXPECT_LT(gaps[1], gaps[0] / 4) << "not a hard case";
  }
}

// All axes of a ball are alike, and those across the string turn with it.
TEST(TensionInBullet, LeavesABallFreeToSpinAboutItsString) {
  for (const double load : {0, 20, 200}) {
    bullet::ConstraintSolver solver;
    World world(&solver);
    const btVector3 up(0, btScalar(0.5), 0);
    btRigidBody* const ball =
        world.AddSphere(btScalar(0.05), {.mass = 1, .pose = At(0, 10, 0), .surface = {}});
    world.AddJoint(std::make_unique<btPoint2PointConstraint>(*ball, up),
                   bench::ConnectedBodies::kPassThrough);
    if (load > 0) {
      btRigidBody* const weight = world.AddSphere(
          btScalar(0.2), {.mass = btScalar(load), .pose = At(0, 9, 0), .surface = {}});
      world.AddJoint(std::make_unique<btPoint2PointConstraint>(*ball, *weight, -up, up),
                     bench::ConnectedBodies::kPassThrough);
    }
    ball->setAngularVelocity({0, 10, 0});
    for (int i = 0; i < 300; ++i) world.Step();
    EXPECT_NEAR(ball->getAngularVelocity().y(), 10, 0.01) << load;
  }
}

TEST(TensionInBullet, StaysWithinABudgetOfWork) {
  for (const std::int64_t units : {200, 2000, 20000}) {
    LoadedChain on(1000, {.budget = Budget::Work(units)}, {}, 0.3);
    EXPECT_LT(on.GapOf(240), units < 2000 ? 2 : 0.1) << units;
    EXPECT_LE(on.solver.report().work, 2 * units);
  }
}

}  // namespace
}  // namespace cairn::test
