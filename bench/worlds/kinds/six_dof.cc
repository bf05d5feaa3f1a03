// SPDX-License-Identifier: MIT
// Rows of 6-dof joints with limits, springs and motors.
#include <cmath>

#include "worlds/kinds/parts.h"

namespace cairn::bench {
namespace {

/// Bodies in a row along x, the first one static or all lying on the floor.
struct Row {
  std::vector<btRigidBody*> bodies;
  std::vector<btVector3> joints;
  btScalar mass;
};

Row AddRow(Draft* draft) {
  draft->Ground();
  const int count = draft->Count(2, 16);
  const btScalar half = draft->Draw(0.15, 0.4), pitch = 2 * half * draft->Draw(1.05, 1.6);
  const bool held = draft->Chance(0.7);
  const btScalar height = held ? half + pitch * btScalar(count) * draft->Draw(0.1, 1) : half;
  Row row;
  row.mass = draft->DrawRatio(0.5, 5);
  const btScalar growth = std::pow(draft->DrawRatio(0.3, 100), 1 / btScalar(count));
  btScalar mass = row.mass;
  for (int i = 0; i < count; ++i, mass *= growth) {
    const btVector3 at(pitch * btScalar(i), height, 0);
    row.bodies.push_back(draft->Box(btVector3(half, half, half), held && i == 0 ? 0 : mass,
                                    At(at.x(), at.y(), at.z())));
    if (i > 0) row.joints.push_back(at - btVector3(pitch / 2, 0, 0));
  }
  return row;
}

/// Locked, limited or free, for each axis.
struct Limits {
  btVector3 linear_low{0, 0, 0}, linear_high{0, 0, 0}, low{0, 0, 0}, high{0, 0, 0};
};

Limits DrawLimits(Draft* draft, double free_linear) {
  Limits limits;
  for (int axis = 0; axis < 3; ++axis) {
    if (draft->Chance(free_linear)) {
      limits.linear_high[axis] = draft->Draw(0.02, 0.2);
      limits.linear_low[axis] = -draft->Draw(0.02, 0.2);
    }
    if (draft->Chance(0.6)) {
      limits.high[axis] = draft->Draw(0.05, 1);
      limits.low[axis] = -draft->Draw(0.05, 1);
    }
  }
  return limits;
}

template <class Joint>
void SetLimits(const Limits& limits, Joint* joint) {
  joint->setLinearLowerLimit(limits.linear_low);
  joint->setLinearUpperLimit(limits.linear_high);
  joint->setAngularLowerLimit(limits.low);
  joint->setAngularUpperLimit(limits.high);
}

template <class Joint>
Joint* AddSixDof(Draft* draft, const Row& row, size_t i) {
  btRigidBody *const a = row.bodies[i], *const b = row.bodies[i + 1];
  const btTransform frame(btQuaternion::getIdentity(), row.joints[i]);
  if constexpr (std::is_same_v<Joint, btGeneric6DofSpring2Constraint>) {
    return draft->Add(std::make_unique<Joint>(*a, *b, Local(*a, frame), Local(*b, frame)));
  } else {
    return draft->Add(std::make_unique<Joint>(*a, *b, Local(*a, frame), Local(*b, frame), true));
  }
}

/// The stiffness in which a mass swings with 1 to 6 Hz [N/m].
btScalar DrawStiffness(Draft* draft, btScalar mass) {
  const btScalar omega = SIMD_2_PI * draft->Draw(1, 6);
  return mass * omega * omega;
}

}  // namespace

void DrawSixDofRow(Draft* draft) {
  const Row row = AddRow(draft);
  const Limits limits = DrawLimits(draft, 0.2);
  const bool motors = draft->Chance(0.5);
  const btScalar speed = draft->Draw(-2, 2), force = row.mass * draft->DrawRatio(0.3, 10);
  for (size_t i = 0; i < row.joints.size(); ++i) {
    auto* const joint = AddSixDof<btGeneric6DofConstraint>(draft, row, i);
    SetLimits(limits, joint);
    if (!motors || i % 3 != 0) continue;
    btRotationalLimitMotor* const motor = joint->getRotationalLimitMotor(draft->Choose(3));
    motor->m_enableMotor = true;
    motor->m_targetVelocity = speed;
    motor->m_maxMotorForce = force;
  }
}

void DrawSpringRow(Draft* draft) {
  const Row row = AddRow(draft);
  const Limits limits = DrawLimits(draft, 0.3);
  const int axis = draft->Choose(6);
  const btScalar stiffness = DrawStiffness(draft, row.mass) * btScalar(axis < 3 ? 1 : 0.05);
  const btScalar damping = draft->Draw(0.1, 1);
  for (size_t i = 0; i < row.joints.size(); ++i) {
    auto* const joint = AddSixDof<btGeneric6DofSpringConstraint>(draft, row, i);
    SetLimits(limits, joint);
    joint->enableSpring(axis, true);
    joint->setStiffness(axis, stiffness);
    joint->setDamping(axis, damping);
    joint->setEquilibriumPoint();
  }
}

void DrawSpring2Row(Draft* draft) {
  const Row row = AddRow(draft);
  const Limits limits = DrawLimits(draft, 0.3);
  const int axis = draft->Choose(6), motor = 3 + draft->Choose(3);
  const btScalar stiffness = DrawStiffness(draft, row.mass) * btScalar(axis < 3 ? 1 : 0.05);
  const btScalar damping = stiffness * draft->Draw(0.01, 0.1), speed = draft->Draw(-2, 2);
  const btScalar force = row.mass * draft->DrawRatio(0.3, 10);
  const bool motors = draft->Chance(0.5), servo = draft->Chance(0.3);
  for (size_t i = 0; i < row.joints.size(); ++i) {
    auto* const joint = AddSixDof<btGeneric6DofSpring2Constraint>(draft, row, i);
    SetLimits(limits, joint);
    joint->enableSpring(axis, true);
    joint->setStiffness(axis, stiffness);
    joint->setDamping(axis, damping);
    joint->setEquilibriumPoint();
    if (!motors || i % 3 != 0) continue;
    joint->enableMotor(motor, true);
    joint->setTargetVelocity(motor, speed);
    joint->setMaxMotorForce(motor, force);
    if (servo) {
      joint->setServo(motor, true);
      joint->setServoTarget(motor, speed / 4);
    }
  }
}

}  // namespace cairn::bench
