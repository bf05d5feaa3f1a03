// SPDX-License-Identifier: MIT
// The instruments of bench/measure: what they restore, and what they do not count.
#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>
#include <btBulletDynamicsCommon.h>
#include <cairn/bullet/constraint_solver.h>
#include <gtest/gtest.h>

#include <bit>
#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <thread>
#include <type_traits>
#include <vector>

#include "measure/instrumented_solver.h"
#include "measure/observed.h"
#include "measure/reference.h"

namespace cairn::bench {
namespace {

using Bits = std::conditional_t<sizeof(btScalar) == sizeof(float), std::uint32_t, std::uint64_t>;

/// Five boxes, one on the other, and a sixth that hangs from the topmost on a pin; all tilted a
/// little, so that everything has to turn.
class StackWorld {
 public:
  explicit StackWorld(btConstraintSolver* solver)
      : world_(&dispatcher_, &broadphase_, solver, &configuration_) {
    world_.setGravity(btVector3(0, btScalar(-9.81), 0));
    AddBody(0, &ground_, btVector3(0, 0, 0));
    for (int i = 0; i < 5; ++i) {
      AddBody(btScalar(1 + i), &box_, btVector3(btScalar(0.05 * i), btScalar(0.5 + i), 0));
    }
    AddBody(2, &box_, btVector3(btScalar(1.5), btScalar(4.5), 0));
    pin_ = std::make_unique<btPoint2PointConstraint>(*bodies_[5], *bodies_[6],
                                                     btVector3(btScalar(0.65), 0, 0),
                                                     btVector3(btScalar(-0.65), 0, 0));
    pin_->setJointFeedback(&feedback_);
    pin_->enableFeedback(true);
    pin_->setBreakingImpulseThreshold(btScalar(0.05));  // breaks at once
    world_.addConstraint(pin_.get());
  }

  ~StackWorld() {
    world_.removeConstraint(pin_.get());
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }

  void Step(int frames) {
    for (int i = 0; i < frames; ++i) world_.stepSimulation(btScalar(1) / 60, 0);
  }

  /// The bits of everything that a solver writes. Feedback and the directions of new points are
  /// what memory was, which may be NaN, until a solver writes them.
  std::vector<Bits> State() {
    std::vector<btScalar> state;
    const auto add = [&state](const btVector3& v) {
      state.insert(state.end(), {v.x(), v.y(), v.z()});
    };
    for (const auto& body : bodies_) {
      add(body->getLinearVelocity());
      add(body->getAngularVelocity());
      add(body->getWorldTransform().getOrigin());
      for (int i = 0; i < 3; ++i) add(body->getWorldTransform().getBasis()[i]);
    }
    for (int m = 0; m < dispatcher_.getNumManifolds(); ++m) {
      const btPersistentManifold* manifold = dispatcher_.getManifoldByIndexInternal(m);
      for (int i = 0; i < manifold->getNumContacts(); ++i) {
        const btManifoldPoint& point = manifold->getContactPoint(i);
        state.insert(state.end(), {point.m_appliedImpulse, point.m_appliedImpulseLateral1,
                                   point.m_appliedImpulseLateral2});
        add(point.m_lateralFrictionDir1);
      }
    }
    state.push_back(pin_->isEnabled() ? btScalar(1) : btScalar(0));
    state.push_back(pin_->internalGetAppliedImpulse());
    add(feedback_.m_appliedForceBodyA);
    std::vector<Bits> bits;
    for (const btScalar number : state) bits.push_back(std::bit_cast<Bits>(number));
    return bits;
  }

 private:
  void AddBody(btScalar mass, btCollisionShape* shape, const btVector3& origin) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(mass, inertia);
    bodies_.push_back(std::make_unique<btRigidBody>(mass, nullptr, shape, inertia));
    bodies_.back()->setWorldTransform(
        btTransform(btQuaternion(btVector3(0, 0, 1), mass > 0 ? btScalar(0.01) : 0), origin));
    world_.addRigidBody(bodies_.back().get());
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btDiscreteDynamicsWorld world_;
  btStaticPlaneShape ground_{btVector3(0, 1, 0), 0};
  btBoxShape box_{btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5))};
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::unique_ptr<btPoint2PointConstraint> pin_;
  btJointFeedback feedback_;
};

std::vector<std::unique_ptr<btConstraintSolver>> ManySolvers() {
  std::vector<std::unique_ptr<btConstraintSolver>> solvers;
  solvers.push_back(std::make_unique<btSequentialImpulseConstraintSolver>());
  solvers.push_back(std::make_unique<btNNCGConstraintSolver>());
  solvers.push_back(std::make_unique<bullet::ConstraintSolver>());
  solvers.push_back(std::make_unique<bullet::ConstraintSolver>(ReferenceSettings()));
  return solvers;
}

TEST(SubstepTest, RestoreBringsBackEveryBitThatASolverWrote) {
  btSequentialImpulseConstraintSolver own;
  InstrumentedSolver instrumented(&own);
  StackWorld world(&instrumented);
  for (int frame = 0; frame < 20; ++frame) {
    instrumented.ProbeNext([&](Substep* substep, const btContactSolverInfo& info) {
      const std::vector<Bits> before = world.State();
      for (const auto& solver : ManySolvers()) {
        substep->SolveWith(solver.get(), info, nullptr);
        EXPECT_NE(world.State(), before);
        substep->Restore();
        EXPECT_EQ(world.State(), before);
      }
    });
    world.Step(1);
  }
}

TEST(SubstepTest, AProbedWorldGoesOnAsIfItHadNotBeenProbed) {
  btSequentialImpulseConstraintSolver own, undisturbed;
  InstrumentedSolver instrumented(&own);
  StackWorld probed(&instrumented), plain(&undisturbed);
  for (int frame = 0; frame < 60; ++frame) {
    instrumented.ProbeNext([](Substep* substep, const btContactSolverInfo& info) {
      for (const auto& solver : ManySolvers()) substep->SolveWith(solver.get(), info, nullptr);
    });
    probed.Step(1);
    plain.Step(1);
    ASSERT_EQ(probed.State(), plain.State()) << "frame " << frame;
  }
}

TEST(SubstepTest, ASolverGivenTheSameStateTwiceGivesTheSameBits) {
  btSequentialImpulseConstraintSolver own;
  InstrumentedSolver instrumented(&own);
  StackWorld world(&instrumented);
  world.Step(10);
  bool probed = false;
  instrumented.ProbeNext([&](Substep* substep, const btContactSolverInfo& info) {
    const auto first = ManySolvers(), second = ManySolvers();
    for (size_t i = 0; i < first.size(); ++i) {
      substep->SolveWith(first[i].get(), info, nullptr);
      const std::vector<Bits> once = world.State();
      substep->Restore();
      substep->SolveWith(second[i].get(), info, nullptr);
      EXPECT_EQ(world.State(), once) << "solver " << i;
      substep->Restore();
    }
    probed = true;
  });
  world.Step(1);
  EXPECT_TRUE(probed);
}

TEST(SubstepTest, EveryBodyThatMayMoveIsNamedOnce) {
  btSequentialImpulseConstraintSolver own;
  InstrumentedSolver instrumented(&own);
  StackWorld world(&instrumented);
  instrumented.ProbeNext([](Substep* substep, const btContactSolverInfo&) {
    EXPECT_EQ(substep->bodies().size(), 6u);
  });
  world.Step(1);
}

TEST(InstrumentedSolverTest, TimeInTheProbeIsNotCounted) {
  using std::chrono::milliseconds;
  btSequentialImpulseConstraintSolver own;
  InstrumentedSolver instrumented(&own);
  StackWorld world(&instrumented);
  world.Step(5);
  EXPECT_GT(instrumented.TakeTime().count(), 0);
  // Far longer than the six boxes take, even on a machine that does other work.
  constexpr milliseconds kPause(500);
  instrumented.ProbeNext(
      [kPause](Substep*, const btContactSolverInfo&) { std::this_thread::sleep_for(kPause); });
  world.Step(1);
  const auto time = instrumented.TakeTime();
  EXPECT_GT(time.count(), 0);
  EXPECT_LT(time, kPause);
  EXPECT_EQ(instrumented.TakeTime().count(), 0) << "taken is taken";
}

TEST(ObservedTest, WhatIsReadIsWhatIsWrittenBack) {
  Observed<btSequentialImpulseConstraintSolver> solver;
  StackWorld world(&solver);
  world.Step(10);
  int groups = 0;
  double residual = -1;
  solver.Observe([&](bullet::GroupRows& rows) {
    ++groups;
    const Report report = Measure(rows.problem(), rows.impulses());
    ASSERT_TRUE(report.ok());
    residual = report.residual_max;
  });
  world.Step(1);
  EXPECT_EQ(groups, 1);
  EXPECT_GT(residual, 0);
  EXPECT_LT(residual, 1);  // ten sweeps on six boxes
  EXPECT_GT(solver.TakeObservingTime().count(), 0);
}

TEST(ReferenceTest, TheReferenceIsFarCloserThanTenSweeps) {
  btSequentialImpulseConstraintSolver own;
  InstrumentedSolver instrumented(&own);
  StackWorld world(&instrumented);
  world.Step(30);
  bool probed = false;
  instrumented.ProbeNext([&](Substep* substep, const btContactSolverInfo& info) {
    bullet::ConstraintSolver reference(ReferenceSettings());
    substep->SolveWith(&reference, info, nullptr);
    const double left = reference.report().residual_max;
    EXPECT_LT(left, 1e-4);
    const auto truth = ReadVelocities(substep->bodies());
    substep->Restore();
    substep->SolveWith(&own, info, nullptr);
    EXPECT_GT(VelocityError(truth, ReadVelocities(substep->bodies())), 30 * left);
    probed = true;
  });
  world.Step(1);
  EXPECT_TRUE(probed);
}

TEST(VelocityErrorTest, IsTheLongestDifferenceOfLinearVelocities) {
  std::vector<Velocity> a(3), b(3);
  a[1].linear = {1, 2, 3};
  b[1].linear = {1, 5, 7};  // 0, 3, 4 apart
  b[2].linear = {0, 0, -4};
  b[0].angular = {100, 0, 0};  // not looked at
  EXPECT_DOUBLE_EQ(VelocityError(a, b), 5);
  EXPECT_DOUBLE_EQ(VelocityError(b, b), 0);
}

TEST(VelocityErrorTest, NotANumberIsInfinitelyWrong) {
  std::vector<Velocity> a(2), b(2);
  b[0].linear = {0, std::numeric_limits<double>::quiet_NaN(), 0};
  b[1].linear = {1, 0, 0};
  EXPECT_EQ(VelocityError(a, b), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace cairn::bench
