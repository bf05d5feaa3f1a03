// SPDX-License-Identifier: MIT
// What Mode::kFast leaves in bodies and joints, against Bullet's own solver from the same state.
// Without warm starts and with plain sweeps in order both make the same iteration of joints.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <vector>

#include "cairn/bullet/constraint_solver.h"
#include "measure/instrumented_solver.h"
#include "tests/bullet_adapter/joint_world.h"
#include "tests/bullet_adapter/scene_world.h"

namespace cairn::test {
namespace {

using bench::At;
using bench::Substep;
using bench::World;

Settings PlainSweeps() { return {.path = Path::kReference, .k_sm = 0}; }

/// Everything that a solver writes to bodies and joints.
struct Outcome {
  std::vector<double> values;
  std::vector<bool> enabled;
};

void Append(const btVector3& v, std::vector<double>* values) {
  values->insert(values->end(), {v.x(), v.y(), v.z()});
}

Outcome ReadOutcome(const Substep& substep) {
  Outcome outcome;
  for (const btRigidBody* body : substep.bodies()) {
    Append(body->getLinearVelocity(), &outcome.values);
    Append(body->getAngularVelocity(), &outcome.values);
  }
  for (const Substep::Group& group : substep.groups()) {
    for (btTypedConstraint* joint : group.joints) {
      outcome.values.push_back(joint->internalGetAppliedImpulse());
      outcome.enabled.push_back(joint->isEnabled());
      const btJointFeedback* const feedback = joint->getJointFeedback();
      if (feedback == nullptr) continue;
      Append(feedback->m_appliedForceBodyA, &outcome.values);
      Append(feedback->m_appliedForceBodyB, &outcome.values);
      Append(feedback->m_appliedTorqueBodyA, &outcome.values);
      Append(feedback->m_appliedTorqueBodyB, &outcome.values);
    }
  }
  return outcome;
}

Outcome SolveFrom(const Substep& substep, btConstraintSolver* solver,
                  const btContactSolverInfo& info) {
  substep.Restore();
  substep.SolveWith(solver, info, nullptr);
  return ReadOutcome(substep);
}

/// Ten sweeps of rows whose numbers Bullet rounds at each operation, as in parity_test.cc; forces
/// are impulses by the time step, so differences are relative to the largest value.
void ExpectSame(const Outcome& ours, const Outcome& bullets) {
  double largest = 0, scale = 1e-30;
  for (size_t i = 0; i < bullets.values.size(); ++i) {
    largest = std::max(largest, std::abs(ours.values[i] - bullets.values[i]));
    scale = std::max(scale, std::abs(bullets.values[i]));
  }
  EXPECT_LE(largest, 500 * kBulletEpsilon * scale);
  EXPECT_EQ(ours.enabled, bullets.enabled);
}

class JointsOfKind : public testing::TestWithParam<JointKind> {
 protected:
  /// Compares over 60 frames that are driven by Bullet. Returns how many joints broke.
  int Compare(btScalar breaking) {
    btSequentialImpulseConstraintSolver driver, bullets;
    bullet::ConstraintSolver ours(PlainSweeps(), {.warm_start_joints = false});
    bench::InstrumentedSolver instrumented(&driver);
    World world(&instrumented);
    BuildJointWorld(GetParam(), &world);
    // Bullet's step leaves locked axes out, Cairn's does not
    for (btRigidBody* body : world.dynamic_bodies()) {
      body->setLinearFactor({1, 1, 1});
      body->setAngularFactor({1, 1, 1});
    }
    std::vector<btJointFeedback> feedback(world.joints().size());
    for (size_t i = 0; i < feedback.size(); ++i) {
      world.joints()[i]->setJointFeedback(&feedback[i]);
      world.joints()[i]->setBreakingImpulseThreshold(breaking);
    }
    for (int frame = 0; frame < 60; ++frame) {
      instrumented.ProbeNext([&](Substep* substep, const btContactSolverInfo& info) {
        ExpectSame(SolveFrom(*substep, &ours, info), SolveFrom(*substep, &bullets, info));
        EXPECT_FALSE(ours.fell_back());
      });
      world.Step();
    }
    return static_cast<int>(std::ranges::count_if(
        world.joints(), [](const btTypedConstraint* joint) { return !joint->isEnabled(); }));
  }
};

TEST_P(JointsOfKind, GetBulletsImpulsesAndFeedbackAndTheirBodiesItsVelocities) {
  EXPECT_EQ(Compare(SIMD_INFINITY), 0);
}

TEST_P(JointsOfKind, BreakWhenBulletsDo) { EXPECT_GT(Compare(btScalar(0.02)), 0); }

struct KindName {
  template <class Info>
  std::string operator()(const Info& info) const {
    return std::string(info.param.name);
  }
};

INSTANTIATE_TEST_SUITE_P(Every, JointsOfKind, testing::ValuesIn(JointKinds()), KindName());

TEST(JointContract, ADisabledJointGetsZeroFeedbackAndImpulse) {
  bullet::ConstraintSolver solver;
  World world(&solver);
  BuildJointWorld(JointKinds()[0], &world);
  btTypedConstraint* const joint = world.joints()[1];
  btJointFeedback feedback{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
  joint->setJointFeedback(&feedback);
  joint->internalSetAppliedImpulse(7);
  joint->setEnabled(false);
  world.Step();
  EXPECT_TRUE(feedback.m_appliedForceBodyA.isZero() && feedback.m_appliedTorqueBodyB.isZero());
  EXPECT_EQ(joint->internalGetAppliedImpulse(), 0);
  EXPECT_FALSE(joint->isEnabled());
}

TEST(JointContract, AJointStartsFromTheImpulsesOfTheSubstepBefore) {
  const auto gap_with = [](bool warm_start) {
    bullet::ConstraintSolver solver(PlainSweeps(), {.warm_start_joints = warm_start});
    SceneWorld world("chain", &solver);
    world.Step(120);
    return world.Measure().joint_gap_m;
  };
  EXPECT_LT(gap_with(true), 0.5 * gap_with(false));
}

/// One box that hangs by a point.
struct Hanging {
  explicit Hanging(btConstraintSolver* solver) : world(solver) {
    box = world.AddBox(btVector3(1, 1, 1) / 4, {.mass = 2, .pose = At(0, 5, 0), .surface = {}});
  }
  /// In memory of the caller, so that joints can follow each other at one address.
  void Hang(const btVector3& pivot, void* memory) {
    joint = new (memory) btPoint2PointConstraint(*box, pivot);
    world.bullet()->addConstraint(joint);
  }
  void Drop() {
    world.bullet()->removeConstraint(joint);
    joint->~btPoint2PointConstraint();
  }

  World world;
  btRigidBody* box;
  btPoint2PointConstraint* joint = nullptr;
};

TEST(JointContract, AJointAtTheAddressOfARemovedOneStartsCold) {
  alignas(16) std::byte memory[sizeof(btPoint2PointConstraint)];
  const auto velocity_after = [&](bool warm_start) {
    // one sweep, so that the start shows
    bullet::ConstraintSolver solver(PlainSweeps(), {.warm_start_joints = warm_start});
    Hanging scene(&solver);
    scene.world.solver_info().m_numIterations = 1;
    scene.Hang({0, 1, 0}, memory);
    scene.world.Step();  // from rest: the same with and without a start
    scene.Drop();
    scene.Hang({1, 1, 0}, memory);
    scene.world.Step();
    const btVector3 velocity = scene.box->getLinearVelocity();
    scene.Drop();
    return velocity;
  };
  const btVector3 cold = velocity_after(false), warm = velocity_after(true);
  EXPECT_EQ(cold.x(), warm.x());
  EXPECT_EQ(cold.y(), warm.y());
  EXPECT_EQ(cold.z(), warm.z());
}

TEST(JointContract, WorldsThatShareASolverStartTheirJointsCold) {
  const auto hash_with = [](bool warm_start, bool shared) {
    bullet::ConstraintSolver solver(PlainSweeps(), {.warm_start_joints = warm_start});
    World world(&solver), other(&solver);
    BuildJointWorld(JointKinds()[1], &world);
    BuildJointWorld(JointKinds()[0], &other);
    for (int i = 0; i < 30; ++i) {
      world.Step();
      if (shared) other.Step();
    }
    return bench::StateHash(world);
  };
  EXPECT_EQ(hash_with(true, true), hash_with(false, false));
  EXPECT_NE(hash_with(true, false), hash_with(false, false));
}

/// A joint of a user: holds the height of a body.
class HeightJoint : public btTypedConstraint {
 public:
  explicit HeightJoint(btRigidBody* body) : btTypedConstraint(MAX_CONSTRAINT_TYPE, *body) {}
  void getInfo1(btConstraintInfo1* info) override { *info = {1, 0}; }
  void getInfo2(btConstraintInfo2* info) override { info->m_J1linearAxis[1] = 1; }
  void setParam(int, btScalar, int) override {}
  btScalar getParam(int, int) const override { return 0; }
};

TEST(JointContract, AJointOfAUsersTypeIsLeftToTheReferenceMode) {
  const auto run = [](bullet::Mode mode, bool* fell_back) {
    bullet::ConstraintSolver solver({}, {.mode = mode});
    World world(&solver);
    btRigidBody* const box = world.AddBox(btVector3(1, 1, 1) / 4, {.mass = 2, .pose = At(0, 5, 0)});
    btRigidBody* const other =
        world.AddBox(btVector3(1, 1, 1) / 4, {.mass = 2, .pose = At(0, 4, 0)});
    world.AddJoint(std::make_unique<HeightJoint>(box), bench::ConnectedBodies::kCollide);
    world.AddJoint(std::make_unique<btPoint2PointConstraint>(*box, *other, btVector3(0, -1, 0),
                                                             btVector3(0, 0, 0)),
                   bench::ConnectedBodies::kPassThrough);
    for (int i = 0; i < 20; ++i) world.Step();
    EXPECT_NEAR(box->getCenterOfMassPosition().y(), 5, 1e-4);
    *fell_back = solver.fell_back();
    return bench::StateHash(world);
  };
  bool fast_fell = false, reference_fell = true;
  EXPECT_EQ(run(bullet::Mode::kFast, &fast_fell), run(bullet::Mode::kReference, &reference_fell));
  EXPECT_TRUE(fast_fell);
  EXPECT_FALSE(reference_fell);
}

TEST(JointContract, IslandsWithoutAJointOfAUsersTypeAreSolvedAsWithoutIt) {
  const auto run = [](bool with) {
    bullet::ConstraintSolver solver;
    SceneWorld scene("chain", &solver);
    const std::vector<btRigidBody*> chain(scene.world().dynamic_bodies().begin(),
                                          scene.world().dynamic_bodies().end());
    btRigidBody* const box =
        scene.world().AddBox(btVector3(1, 1, 1) / 4, {.mass = 2, .pose = At(100, 5, 0)});
    if (with) {
      scene.world().AddJoint(std::make_unique<HeightJoint>(box), bench::ConnectedBodies::kCollide);
    }
    scene.Step(60);
    EXPECT_EQ(solver.fell_back(), with);
    EXPECT_EQ(solver.complaint(), "");
    EXPECT_EQ(solver.report().islands.size(), 1u) << "the report is that of the chain";
    if (with) {
      EXPECT_NEAR(box->getCenterOfMassPosition().y(), 5, 1e-4);
    }
    std::vector<btScalar> places;
    for (const btRigidBody* link : chain) {
      const btVector3& at = link->getCenterOfMassPosition();
      places.insert(places.end(), {at.x(), at.y(), at.z()});
    }
    return places;
  };
  EXPECT_EQ(run(true), run(false));
}

// What is left to the reference mode unread is not judged by what was wrong in the step before.
TEST(JointContract, AJointOfAUsersTypeIsNotBlamedForTheLastStep) {
  bullet::ConstraintSolver solver;
  World world(&solver);
  const auto hang_box = [&world] {
    btRigidBody* const box = world.AddBox(btVector3(1, 1, 1) / 4, {.mass = 2, .pose = At(0, 5, 0)});
    world.AddJoint(std::make_unique<HeightJoint>(box), bench::ConnectedBodies::kCollide);
    return box;
  };
  btRigidBody* const bad = hang_box();
  bad->setLinearVelocity({0, std::numeric_limits<btScalar>::quiet_NaN(), 0});
  world.Step();
  ASSERT_FALSE(solver.report().ok());
  world.Remove(bad);
  hang_box();
  world.Step();
  EXPECT_TRUE(solver.fell_back());
  EXPECT_EQ(solver.complaint(), "");
}

TEST(JointContract, AMotorWithANegativeStrengthHasNone) {
  bullet::ConstraintSolver solver;
  World world(&solver);
  btRigidBody* const door = world.AddBox({1, 1, btScalar(0.1)}, {.mass = 2, .pose = At(1, 5, 0)});
  auto hinge = std::make_unique<btHingeConstraint>(*door, btVector3(-1, 0, 0), btVector3(0, 1, 0));
  hinge->enableAngularMotor(true, 1, -1);
  world.AddJoint(std::move(hinge), bench::ConnectedBodies::kPassThrough);
  for (int i = 0; i < 30; ++i) world.Step();
  EXPECT_FALSE(solver.fell_back());
  EXPECT_NEAR(door->getAngularVelocity().y(), 0, 1e-4);
}

}  // namespace
}  // namespace cairn::test
