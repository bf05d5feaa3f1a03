// SPDX-License-Identifier: MIT
#include "worlds/conditions/units.h"

#include <set>

namespace cairn::bench {
namespace {

/// Of one change: factors of lengths, forces and speeds, and of torques and inertias.
class Units {
 public:
  explicit Units(double per_metre) : length_(static_cast<btScalar>(per_metre)) {}

  void Change(btCollisionShape* shape) const {
    const btScalar margin = shape->getMargin();
    shape->setLocalScaling(length_ * shape->getLocalScaling());
    const bool is_round = shape->getShapeType() == SPHERE_SHAPE_PROXYTYPE ||
                          shape->getShapeType() == CAPSULE_SHAPE_PROXYTYPE;
    if (!is_round) shape->setMargin(length_ * margin);
  }
  void Change(btRigidBody* body) const {
    btTransform pose = body->getWorldTransform();
    pose.setOrigin(length_ * pose.getOrigin());
    body->setWorldTransform(pose);
    body->setInterpolationWorldTransform(pose);
    body->setLinearVelocity(length_ * body->getLinearVelocity());
    body->setInterpolationLinearVelocity(body->getLinearVelocity());
    body->setSleepingThresholds(length_ * body->getLinearSleepingThreshold(),
                                body->getAngularSleepingThreshold());
    // levers of what presses
    body->setRollingFriction(length_ * body->getRollingFriction());
    body->setSpinningFriction(length_ * body->getSpinningFriction());
    if (body->getInvMass() > 0) {
      body->setInvInertiaDiagLocal(body->getInvInertiaDiagLocal() / (length_ * length_));
      body->updateInertiaTensor();
    }
  }
  void Change(btTypedConstraint* joint) const {
    const btScalar breaks_at = joint->getBreakingImpulseThreshold();
    if (breaks_at < SIMD_INFINITY) joint->setBreakingImpulseThreshold(length_ * breaks_at);
    switch (joint->getConstraintType()) {
      case POINT2POINT_CONSTRAINT_TYPE:
        return ChangePins(static_cast<btPoint2PointConstraint*>(joint));
      case HINGE_CONSTRAINT_TYPE: {
        auto* const hinge = static_cast<btHingeConstraint*>(joint);
        hinge->setMaxMotorImpulse(Torque(hinge->getMaxMotorImpulse()));
        return ChangeFrames(hinge);
      }
      case CONETWIST_CONSTRAINT_TYPE:
        return ChangeFrames(static_cast<btConeTwistConstraint*>(joint));
      case SLIDER_CONSTRAINT_TYPE:
        return ChangeSlider(static_cast<btSliderConstraint*>(joint));
      case D6_CONSTRAINT_TYPE:
      case D6_SPRING_CONSTRAINT_TYPE:
        return ChangeSixDof(joint);
      case D6_SPRING_2_CONSTRAINT_TYPE:
      case FIXED_CONSTRAINT_TYPE:
        return ChangeSixDof2(static_cast<btGeneric6DofSpring2Constraint*>(joint));
      default:  // gears turn
        return;
    }
  }
  void Change(btContactSolverInfo* info) const {
    for (btScalar* length : {&info->m_splitImpulsePenetrationThreshold, &info->m_linearSlop,
                             &info->m_restitutionVelocityThreshold}) {
      *length *= length_;
    }
  }
  btVector3 Length(const btVector3& length) const { return length_ * length; }

 private:
  btScalar Torque(btScalar torque) const { return length_ * length_ * torque; }
  btTransform Frame(btTransform frame) const {
    frame.setOrigin(length_ * frame.getOrigin());
    return frame;
  }
  template <class Joint>
  void ChangeFrames(Joint* joint) const {
    joint->setFrames(Frame(joint->getFrameOffsetA()), Frame(joint->getFrameOffsetB()));
  }
  void ChangePins(btPoint2PointConstraint* joint) const {
    joint->setPivotA(length_ * joint->getPivotInA());
    joint->setPivotB(length_ * joint->getPivotInB());
    joint->m_setting.m_impulseClamp *= length_;
  }
  void ChangeSlider(btSliderConstraint* joint) const {
    ChangeFrames(joint);
    joint->setLowerLinLimit(length_ * joint->getLowerLinLimit());
    joint->setUpperLinLimit(length_ * joint->getUpperLinLimit());
    joint->setTargetLinMotorVelocity(length_ * joint->getTargetLinMotorVelocity());
    joint->setMaxLinMotorForce(length_ * joint->getMaxLinMotorForce());
    joint->setMaxAngMotorForce(Torque(joint->getMaxAngMotorForce()));
  }
  /// What the two kinds of 6-dof joints have in common.
  template <class Joint>
  void ChangeAxes(Joint* joint) const {
    ChangeFrames(joint);
    auto* const linear = joint->getTranslationalLimitMotor();
    for (btVector3* length : {&linear->m_lowerLimit, &linear->m_upperLimit,
                              &linear->m_targetVelocity, &linear->m_maxMotorForce}) {
      *length *= length_;
    }
    for (int i = 0; i < 3; ++i) {
      auto* const angular = joint->getRotationalLimitMotor(i);
      angular->m_maxMotorForce = Torque(angular->m_maxMotorForce);
    }
  }
  void ChangeSixDof(btTypedConstraint* joint) const {
    auto* const six_dof = static_cast<btGeneric6DofConstraint*>(joint);
    ChangeAxes(six_dof);
    for (int i = 0; i < 3; ++i) {
      btRotationalLimitMotor* const angular = six_dof->getRotationalLimitMotor(i);
      angular->m_maxLimitForce = Torque(angular->m_maxLimitForce);
    }
    if (joint->getConstraintType() != D6_SPRING_CONSTRAINT_TYPE) return;
    auto* const springs = static_cast<btGeneric6DofSpringConstraint*>(joint);
    for (int i = 0; i < 3; ++i) {
      springs->setEquilibriumPoint(i, length_ * springs->getEquilibriumPoint(i));
      springs->setStiffness(3 + i, Torque(springs->getStiffness(3 + i)));
    }
  }
  void ChangeSixDof2(btGeneric6DofSpring2Constraint* joint) const {
    ChangeAxes(joint);
    joint->getTranslationalLimitMotor()->m_equilibriumPoint *= length_;
    for (int i = 0; i < 3; ++i) {
      btRotationalLimitMotor2* const angular = joint->getRotationalLimitMotor(i);
      angular->m_springStiffness = Torque(angular->m_springStiffness);
      angular->m_springDamping = Torque(angular->m_springDamping);
    }
  }

  btScalar length_;
};

}  // namespace

void ChangeUnits(double per_metre, World* world) {
  const Units units(per_metre);
  btDiscreteDynamicsWorld* const bullet = world->bullet();
  std::set<btCollisionShape*> shapes;  // bodies share them
  for (int i = 0; i < bullet->getNumCollisionObjects(); ++i) {
    btRigidBody* const body = btRigidBody::upcast(bullet->getCollisionObjectArray()[i]);
    if (shapes.insert(body->getCollisionShape()).second) units.Change(body->getCollisionShape());
    units.Change(body);
  }
  for (btTypedConstraint* joint : world->joints()) units.Change(joint);
  units.Change(&bullet->getSolverInfo());
  bullet->setGravity(units.Length(bullet->getGravity()));
  bullet->updateAabbs();
}

}  // namespace cairn::bench
