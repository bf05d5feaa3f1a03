// SPDX-License-Identifier: MIT
// A NaN in one object of a world: the others go on, and somebody is told.
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <string>

#include "cairn/bullet/constraint_solver.h"
#include "scenes/world.h"

namespace cairn::test {
namespace {

using bench::At;
using bench::ConnectedBodies;
using bench::World;

constexpr btScalar kNan = std::numeric_limits<btScalar>::quiet_NaN();

/// A stack of four boxes with a rope of four balls at its side.
struct Scene {
  Scene() {
    world.AddGround(10);
    for (int i = 0; i < 4; ++i) {
      boxes[i] = world.AddBox(btVector3(1, 1, 1) / 2,
                              {.mass = 1, .pose = At(0, btScalar(0.5) + btScalar(i), 0)});
    }
    for (int i = 0; i < 4; ++i) {
      balls[i] = world.AddSphere(btScalar(0.2), {.mass = 1, .pose = At(4, 5 - btScalar(i), 0)});
      const btVector3 above(0, 1, 0);
      auto joint = i == 0 ? std::make_unique<btPoint2PointConstraint>(*balls[0], above)
                          : std::make_unique<btPoint2PointConstraint>(*balls[i], *balls[i - 1],
                                                                      above, btVector3(0, 0, 0));
      joints[i] = world.AddJoint(std::move(joint), ConnectedBodies::kPassThrough);
    }
    for (int i = 0; i < 120; ++i) world.Step();
  }

  double Speed(const btRigidBody& body) const {
    return static_cast<double>(body.getLinearVelocity().length());
  }

  bullet::ConstraintSolver solver;
  World world{&solver};
  btRigidBody *boxes[4], *balls[4];
  btTypedConstraint* joints[4];
};

TEST(BadObject, IsLeftOutAndTheOthersGoOn) {
  Scene scene;
  scene.balls[3]->setLinearVelocity({kNan, 0, 0});
  for (int i = 0; i < 120; ++i) {
    scene.world.Step();
    EXPECT_TRUE(scene.solver.fell_back());
    EXPECT_TRUE(scene.solver.report().ok()) << "it is that of the others";
    const std::string complaint = scene.solver.complaint();
    EXPECT_NE(complaint.find("nan, must be finite; left out: 1 body, with index 8 in its world"),
              std::string::npos)
        << complaint;
    for (const btRigidBody* const box : scene.boxes) ASSERT_LT(scene.Speed(*box), 1e-2) << i;
    for (int k = 0; k < 3; ++k) ASSERT_LT(scene.Speed(*scene.balls[k]), 2e-2) << k << " at " << i;
  }
  scene.world.Remove(scene.balls[3]);
  scene.world.Step();
  EXPECT_FALSE(scene.solver.fell_back());
  EXPECT_EQ(scene.solver.complaint(), "");
}

TEST(BadObject, DoesNotSpreadThroughContacts) {
  Scene scene;
  scene.boxes[3]->setAngularVelocity({0, kNan, 0});
  for (int i = 0; i < 60; ++i) {
    scene.world.Step();
    for (int k = 0; k < 3; ++k) ASSERT_LT(scene.Speed(*scene.boxes[k]), 0.1) << k << " at " << i;
  }
}

// A blow computed from a vector of no length.
TEST(BadObject, WithABadForceIsBackInTheNextStep) {
  Scene scene;
  scene.boxes[1]->applyCentralForce({kNan, 0, 0});
  scene.balls[1]->applyTorque({0, 0, kNan});
  scene.world.Step();
  EXPECT_NE(scene.solver.complaint().find("left out: 2 bodies"), std::string::npos)
      << scene.solver.complaint();
  for (int i = 0; i < 60; ++i) {
    scene.world.Step();
    EXPECT_FALSE(scene.solver.fell_back()) << scene.solver.complaint();
  }
  for (const btRigidBody* const body : scene.world.dynamic_bodies()) {
    EXPECT_LT(scene.Speed(*body), 0.1);
    EXPECT_LT(body->getWorldTransform().getOrigin().y(), 5.1);
  }
  EXPECT_NEAR(scene.balls[3]->getWorldTransform().getOrigin().y(), 2, 1e-2);
  EXPECT_NEAR(scene.boxes[3]->getWorldTransform().getOrigin().y(), 3.5, 1e-2);
}

TEST(BadObject, MayBeAJoint) {
  Scene scene;
  auto hinge =
      std::make_unique<btHingeConstraint>(*scene.boxes[0], btVector3(0, 0, 0), btVector3(0, 1, 0));
  btHingeConstraint* const added = hinge.get();
  scene.world.AddJoint(std::move(hinge), ConnectedBodies::kCollide);
  scene.world.Step();
  EXPECT_FALSE(scene.solver.fell_back());
  added->enableAngularMotor(true, kNan, 1);
  scene.world.Step();
  EXPECT_NE(scene.solver.complaint().find("left out: 1 joint"), std::string::npos)
      << scene.solver.complaint();
  added->enableAngularMotor(true, 0, 1);
  for (int i = 0; i < 30; ++i) scene.world.Step();
  EXPECT_EQ(scene.solver.complaint(), "");
  for (const btRigidBody* const body : scene.world.dynamic_bodies()) {
    EXPECT_LT(scene.Speed(*body), 0.1);
  }
}

TEST(BadObject, IsAContactWhoseIslandIsLeftToBullet) {
  Scene scene;
  // points keep the friction that they were found with
  scene.boxes[0]->setFriction(kNan);
  scene.boxes[0]->translate({0, btScalar(0.1), 0});
  scene.world.Step();
  scene.world.Step();
  EXPECT_TRUE(scene.solver.fell_back());
  EXPECT_TRUE(scene.solver.report().ok());
  EXPECT_NE(scene.solver.complaint().find("friction"), std::string::npos)
      << scene.solver.complaint();
  EXPECT_EQ(scene.solver.problem().bodies.size(), 4u) << "the rope";
}

}  // namespace
}  // namespace cairn::test
