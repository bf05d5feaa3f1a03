// SPDX-License-Identifier: MIT
// Games in a plane: bodies whose linear and angular factors lock axes.
#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <BulletDynamics/ConstraintSolver/btGeneric6DofSpring2Constraint.h>
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "cairn/bullet/constraint_solver.h"
#include "scenes/world.h"

namespace cairn::test {
namespace {

using bench::At;
using bench::ConnectedBodies;
using bench::World;

/// A solver, and worlds that it drives.
struct Driver {
  std::string name;
  std::unique_ptr<btConstraintSolver> solver;
};

std::vector<Driver> Drivers() {
  std::vector<Driver> drivers;
  const auto add = [&](const char* name, btConstraintSolver* solver) {
    drivers.push_back({name, std::unique_ptr<btConstraintSolver>(solver)});
  };
  add("as it comes", new bullet::ConstraintSolver);
  add("sweeps", new bullet::ConstraintSolver({.steps = false}));
  add("plain", new bullet::ConstraintSolver({.method = Method::kPgs}));
  add("always", new bullet::ConstraintSolver({.step_policy = StepPolicy::kAlways}));
  add("reference", new bullet::ConstraintSolver({.path = Path::kReference}));
  add("rows", new bullet::ConstraintSolver({}, {.contacts = bullet::ContactForm::kRows}));
  add("Bullet's set-up", new bullet::ConstraintSolver({}, {.mode = bullet::Mode::kReference}));
  add("Bullet's own iteration",
      new bullet::ConstraintSolver({.path = Path::kReference, .steps = false},
                                   {.mode = bullet::Mode::kReference}));
  return drivers;
}

/// The fastest body of so many steps, its spin counted as speed [m/s], [rad/s].
double Fastest(World* world, int frames) {
  btScalar most = 0;
  for (int i = 0; i < frames; ++i) {
    world->Step();
    for (const btRigidBody* body : world->dynamic_bodies()) {
      const btScalar speed =
          std::max(body->getLinearVelocity().length(), body->getAngularVelocity().length());
      if (!(speed <= most)) most = speed;  // what is no number, too
    }
  }
  return most;
}

// Seen from above, height locked, and a little deep in the floor: it was flung at 4,000 m/s.
TEST(LockedAxes, OfBallsOnATableDoNotFlingThem) {
  for (const Driver& driver : Drivers()) {
    World world(driver.solver.get());
    world.AddGround(20);
    for (int i = 0; i < 3; ++i) {
      btRigidBody* const ball = world.AddSphere(
          btScalar(0.5), {.mass = 1, .pose = At(btScalar(1.5) * i, btScalar(0.49), 0)});
      ball->setLinearFactor({1, 0, 1});
      if (i > 0) ball->setAngularFactor({0, 1, 0});
    }
    world.dynamic_bodies()[0]->setLinearVelocity({4, 0, btScalar(0.3)});
    EXPECT_LE(Fastest(&world, 60), 12) << driver.name;
  }
}

// Seen from the side: a pile that touches a wall behind it.
TEST(LockedAxes, OfAPileBeforeAWallDoNotFlingIt) {
  for (const Driver& driver : Drivers()) {
    World world(driver.solver.get());
    world.AddGround(20);
    world.AddBox({20, 10, btScalar(0.5)},
                 {.mass = 0, .pose = At(0, 10, btScalar(-0.99)), .surface = {}});
    for (int i = 0; i < 9; ++i) {
      btRigidBody* const box = world.AddBox(
          btVector3(1, 1, 1) / 2, {.mass = 1,
                                   .pose = At(btScalar(i % 3) * btScalar(1.1),
                                              btScalar(0.5) + (i / 3) * btScalar(1.05), 0)});
      box->setLinearFactor({1, 1, 0});
      box->setAngularFactor({0, 0, 1});
    }
    EXPECT_LE(Fastest(&world, 60), 10) << driver.name;
  }
}

/// A chain in the plane of x and y, of models that are turned by a right angle as modellers have
/// it.
void AddChain(int kind, World* world) {
  const btQuaternion turn(btVector3(1, 0, 0), SIMD_HALF_PI);
  btRigidBody* before = nullptr;
  const auto local = [&](const btVector3& v) { return quatRotate(turn.inverse(), v); };
  const auto frame = [&](btScalar x) { return btTransform(turn.inverse(), local({x, 0, 0})); };
  const btScalar half = btScalar(0.5);
  for (int i = 0; i < 4; ++i) {
    btRigidBody* const link = world->AddBox(
        btVector3(4, 1, 1) / 10, {.mass = 1, .pose = btTransform(turn, {half + i, 5, 0})});
    link->setLinearFactor({1, 1, 0});
    link->setAngularFactor({0, 0, 1});
    std::unique_ptr<btTypedConstraint> joint;
    const btVector3 left = local({-half, 0, 0}), right = local({half, 0, 0}),
                    axis = local({0, 0, 1});
    if (before == nullptr) {
      joint = std::make_unique<btHingeConstraint>(*link, left, axis);
    } else if (kind == 0) {
      joint = std::make_unique<btHingeConstraint>(*before, *link, right, left, axis, axis);
    } else if (kind == 1) {
      joint = std::make_unique<btFixedConstraint>(*before, *link, frame(half), frame(-half));
    } else {
      auto six = std::make_unique<btGeneric6DofSpring2Constraint>(*before, *link, frame(half),
                                                                  frame(-half));
      six->setAngularLowerLimit({0, 0, -1});
      six->setAngularUpperLimit({0, 0, 1});
      joint = std::move(six);
    }
    world->AddJoint(std::move(joint), ConnectedBodies::kPassThrough);
    before = link;
  }
}

// It swings; each joint has rows about axes that its bodies cannot turn about.
TEST(LockedAxes, OfAChainOfTurnedModelsLetItSwing) {
  for (int kind = 0; kind < 3; ++kind) {
    btSequentialImpulseConstraintSolver bullet;
    World expected(&bullet);
    AddChain(kind, &expected);
    const double fastest = Fastest(&expected, 120);
    for (const Driver& driver : Drivers()) {
      World world(driver.solver.get());
      AddChain(kind, &world);
      EXPECT_NEAR(Fastest(&world, 120), fastest, 0.1 * fastest) << driver.name << ", kind " << kind;
      const auto* const solver = static_cast<bullet::ConstraintSolver*>(driver.solver.get());
      EXPECT_FALSE(solver->fell_back()) << driver.name;
    }
  }
}

}  // namespace
}  // namespace cairn::test
