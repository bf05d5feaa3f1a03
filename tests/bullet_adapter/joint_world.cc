// SPDX-License-Identifier: MIT
#include "tests/bullet_adapter/joint_world.h"

#include <BulletDynamics/ConstraintSolver/btGearConstraint.h>
#include <BulletDynamics/ConstraintSolver/btHinge2Constraint.h>

namespace cairn::test {
namespace {

using bench::At;
using bench::World;
using Bodies = std::pair<btRigidBody*, btRigidBody*>;

const btTransform kAbove = At(btScalar(0.1), btScalar(0.6), btScalar(-0.2));
const btTransform kBelow = At(btScalar(-0.1), btScalar(-0.6), btScalar(0.2));

std::unique_ptr<btTypedConstraint> Hinge(btRigidBody* a, btRigidBody* b) {
  return std::make_unique<btHingeConstraint>(*a, *b, kBelow, kAbove);
}

std::unique_ptr<btTypedConstraint> LimitedHinge(btRigidBody* a, btRigidBody* b) {
  auto joint = std::make_unique<btHingeConstraint>(*a, *b, kBelow, kAbove);
  joint->setLimit(btScalar(0.2), btScalar(0.5));
  return joint;
}

std::unique_ptr<btTypedConstraint> DrivenHinge(btRigidBody* a, btRigidBody* b) {
  auto joint = std::make_unique<btHingeConstraint>(*a, *b, kBelow, kAbove);
  joint->enableAngularMotor(true, 3, btScalar(0.4));
  return joint;
}

std::unique_ptr<btTypedConstraint> Slider(btRigidBody* a, btRigidBody* b) {
  auto joint = std::make_unique<btSliderConstraint>(*a, *b, kBelow, kAbove, true);
  joint->setLowerLinLimit(btScalar(0.1));
  joint->setUpperLinLimit(btScalar(0.3));
  joint->setPoweredAngMotor(true);
  joint->setTargetAngMotorVelocity(2);
  joint->setMaxAngMotorForce(5);
  return joint;
}

std::unique_ptr<btTypedConstraint> ConeTwist(btRigidBody* a, btRigidBody* b) {
  auto joint = std::make_unique<btConeTwistConstraint>(*a, *b, kBelow, kAbove);
  joint->setLimit(btScalar(0.1), btScalar(0.05), btScalar(0.02));
  return joint;
}

std::unique_ptr<btTypedConstraint> SixDof(btRigidBody* a, btRigidBody* b) {
  auto joint = std::make_unique<btGeneric6DofConstraint>(*a, *b, kBelow, kAbove, true);
  joint->setLinearLowerLimit({0, btScalar(-0.1), 0});
  joint->setLinearUpperLimit({0, btScalar(0.1), 0});
  joint->setAngularLowerLimit({btScalar(0.1), 0, -1});
  joint->setAngularUpperLimit({btScalar(0.2), 0, 1});
  btRotationalLimitMotor* const motor = joint->getRotationalLimitMotor(2);
  motor->m_enableMotor = true;
  motor->m_targetVelocity = 2;
  motor->m_maxMotorForce = 3;
  return joint;
}

std::unique_ptr<btTypedConstraint> SixDofSpring(btRigidBody* a, btRigidBody* b) {
  auto joint = std::make_unique<btGeneric6DofSpringConstraint>(*a, *b, kBelow, kAbove, true);
  for (int axis = 0; axis < 6; ++axis) {
    joint->enableSpring(axis, axis != 2);
    joint->setStiffness(axis, 40);
    joint->setDamping(axis, btScalar(0.5));
  }
  joint->setLinearLowerLimit({-1, -1, -1});
  joint->setLinearUpperLimit({1, 1, 1});
  joint->setEquilibriumPoint();
  return joint;
}

/// Two rows of one axis that is limited on both sides, a servo, a spring, infinite errors.
std::unique_ptr<btTypedConstraint> SixDofSpring2(btRigidBody* a, btRigidBody* b) {
  auto joint = std::make_unique<btGeneric6DofSpring2Constraint>(*a, *b, kBelow, kAbove);
  joint->setLinearLowerLimit({btScalar(-0.1), 0, 1});
  joint->setLinearUpperLimit({btScalar(0.1), 0, -1});
  joint->setAngularLowerLimit({btScalar(-0.1), 0, btScalar(0.1)});
  joint->setAngularUpperLimit({btScalar(0.1), 0, btScalar(0.2)});
  joint->enableSpring(2, true);
  joint->setStiffness(2, 80);
  joint->setDamping(2, btScalar(0.3));
  joint->enableMotor(0, true);
  joint->setServo(0, true);
  joint->setServoTarget(0, btScalar(0.05));
  joint->setTargetVelocity(0, 1);
  joint->setMaxMotorForce(0, 10);
  joint->setBounce(3, btScalar(0.4));
  return joint;
}

std::unique_ptr<btTypedConstraint> Gear(btRigidBody* a, btRigidBody* b) {
  return std::make_unique<btGearConstraint>(*a, *b, btVector3(0, 1, 0), btVector3(0, 0, 1),
                                            btScalar(1.5));
}

/// Where the chain has the bodies, so that joints with frames in the world fit.
std::unique_ptr<btTypedConstraint> Hinge2(btRigidBody* a, btRigidBody* b) {
  btVector3 anchor = (a->getCenterOfMassPosition() + b->getCenterOfMassPosition()) / 2;
  btVector3 up(0, 1, 0), side(1, 0, 0);
  auto joint = std::make_unique<btHinge2Constraint>(*a, *b, anchor, up, side);
  joint->setLowerLimit(btScalar(-0.1));
  joint->setUpperLimit(btScalar(0.1));
  return joint;
}

std::unique_ptr<btTypedConstraint> Universal(btRigidBody* a, btRigidBody* b) {
  const btVector3 anchor = (a->getCenterOfMassPosition() + b->getCenterOfMassPosition()) / 2;
  auto joint = std::make_unique<btUniversalConstraint>(*a, *b, anchor, btVector3(0, 0, 1),
                                                       btVector3(1, 0, 0));
  joint->setLowerLimit(btScalar(-0.1), btScalar(-0.1));
  joint->setUpperLimit(btScalar(0.1), btScalar(0.1));
  return joint;
}

std::unique_ptr<btTypedConstraint> Accumulating(btRigidBody* a, btRigidBody* b) {
  auto joint = std::make_unique<btHingeAccumulatedAngleConstraint>(*a, *b, kBelow, kAbove);
  joint->setLimit(btScalar(-0.2), btScalar(0.2));
  return joint;
}

}  // namespace

const std::vector<JointKind>& JointKinds() {
  static const std::vector<JointKind> kinds = {
      {"Point2Point",
       [](btRigidBody* a, btRigidBody* b) {
         return std::make_unique<btPoint2PointConstraint>(*a, *b, kBelow.getOrigin(),
                                                          kAbove.getOrigin());
       }},
      {"Hinge", Hinge},
      {"LimitedHinge", LimitedHinge},
      {"DrivenHinge", DrivenHinge},
      {"AccumulatedAngleHinge", Accumulating},
      {"Slider", Slider},
      {"ConeTwist", ConeTwist},
      {"SixDof", SixDof},
      {"SixDofSpring", SixDofSpring},
      {"SixDofSpring2", SixDofSpring2},
      {"Fixed",
       [](btRigidBody* a, btRigidBody* b) {
         return std::make_unique<btFixedConstraint>(*a, *b, kBelow, kAbove);
       }},
      {"Gear", Gear},
      {"Hinge2", Hinge2},
      {"Universal", Universal},
  };
  return kinds;
}

void BuildJointWorld(const JointKind& kind, World* world) {
  btRigidBody* above = world->AddBox(btVector3(1, 1, 1) / 4, {.pose = At(0, 10, 0)});
  above->setLinearVelocity({btScalar(0.3), 0, 0});  // joints see it, though nothing moves
  for (int i = 1; i <= 3; ++i) {
    const btVector3 sides(btScalar(0.2), btScalar(0.3), btScalar(0.1) * btScalar(i));
    btRigidBody* const box = world->AddBox(
        sides, {.mass = btScalar(i), .pose = At(0, 10 - btScalar(1.2) * btScalar(i), 0)});
    box->setAngularVelocity({1, btScalar(-0.5) * btScalar(i), 2});
    box->setLinearVelocity({btScalar(i), 0, btScalar(-0.3)});
    btTypedConstraint* const joint =
        world->AddJoint(kind.make(above, box), bench::ConnectedBodies::kPassThrough);
    if (i == 2) {
      joint->setBreakingImpulseThreshold(50);
      joint->setOverrideNumSolverIterations(30);
      box->setAngularFactor({1, 0, 1});
      box->setLinearFactor({1, 1, 0});
    }
    above = box;
  }
}

}  // namespace cairn::test
