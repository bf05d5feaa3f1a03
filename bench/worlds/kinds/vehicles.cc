// SPDX-License-Identifier: MIT
// What drives on motors.
#include <algorithm>

#include "worlds/kinds/parts.h"

namespace cairn::bench {
namespace {

/// A chassis with four wheels at its corners.
struct Car {
  btScalar length, width, radius, mass, wheel_mass;  ///< Half lengths [m]; [kg].
  btVector3 at;
};

Car DrawCar(Draft* draft, int index) {
  Car car;
  car.length = draft->Draw(0.8, 1.8);
  car.width = draft->Draw(0.5, 0.9);
  car.radius = draft->Draw(0.25, 0.45);
  car.mass = draft->DrawRatio(20, 1500);
  car.wheel_mass = car.mass / draft->DrawRatio(5, 100);
  car.at = btVector3(0, 2 * car.radius + draft->Draw(0, 0.5), btScalar(4 * index));
  return car;
}

btRigidBody* AddChassis(Draft* draft, const Car& car) {
  return draft->Box(btVector3(car.length, btScalar(0.2), car.width), car.mass,
                    At(car.at.x(), car.at.y(), car.at.z()));
}

/// Wheel i, 0 and 1 in front; it turns about z.
btRigidBody* AddWheel(Draft* draft, const Car& car, int i) {
  const btVector3 at =
      car.at + btVector3((i < 2 ? 1 : -1) * car.length * btScalar(0.8), -car.radius * btScalar(0.6),
                         (i % 2 == 0 ? 1 : -1) * (car.width + btScalar(0.2)));
  const btTransform pose(btQuaternion(btVector3(1, 0, 0), SIMD_HALF_PI), at);
  return draft->Chance(0.5) ? draft->Cylinder(car.radius, btScalar(0.25), car.wheel_mass, pose)
                            : draft->Sphere(car.radius, car.wheel_mass, at);
}

/// Bumps, and sometimes a ramp, in the way of the car.
void AddRoad(Draft* draft) {
  draft->Ground();
  const int bumps = draft->Count(0, 8);
  for (int i = 0; i < bumps; ++i) {
    const btScalar half = draft->Draw(0.02, 0.12), x = btScalar(3 + 2 * i);
    draft->Box(btVector3(half, half, 8), 0, At(x, half / 2, 0));
  }
  if (draft->Chance(0.3)) {
    const btTransform pose(btQuaternion(btVector3(0, 0, 1), draft->Draw(0.1, 0.4)),
                           btVector3(8, 0, 0));
    draft->Box(btVector3(3, btScalar(0.1), 3), 0, pose);
  }
}

}  // namespace

void DrawCar(Draft* draft) {
  AddRoad(draft);
  const int cars = draft->Count(1, 3);
  const btScalar speed = draft->Draw(-25, 25), strength = draft->DrawRatio(0.3, 5);
  for (int n = 0; n < cars; ++n) {
    const Car car = DrawCar(draft, n);
    btRigidBody* const chassis = AddChassis(draft, car);
    const btScalar hertz = draft->Draw(1.5, 4), steer = draft->Draw(0, 0.6);
    for (int i = 0; i < 4; ++i) {
      btRigidBody* const wheel = AddWheel(draft, car, i);
      btVector3 anchor = wheel->getCenterOfMassPosition(), up(0, 1, 0), axle(0, 0, 1);
      auto* const joint =
          draft->Add(std::make_unique<btHinge2Constraint>(*chassis, *wheel, anchor, up, axle));
      joint->setLowerLimit(i < 2 ? -steer : 0);
      joint->setUpperLimit(i < 2 ? steer : 0);
      joint->setLinearLowerLimit(btVector3(0, 0, btScalar(-0.15)));
      joint->setLinearUpperLimit(btVector3(0, 0, btScalar(0.15)));
      const btScalar omega = SIMD_2_PI * hertz;
      joint->setStiffness(2, car.mass / 4 * omega * omega);
      joint->setDamping(2, car.mass / 4 * omega);
      if (i >= 2) {
        joint->enableMotor(3, true);
        joint->setTargetVelocity(3, speed);
        joint->setMaxMotorForce(3, strength * car.mass * car.radius);
      }
    }
  }
}

void DrawSpringCar(Draft* draft) {
  AddRoad(draft);
  const int cars = draft->Count(1, 3);
  const btScalar speed = draft->Draw(-20, 20), strength = draft->DrawRatio(0.3, 5);
  for (int n = 0; n < cars; ++n) {
    const Car car = DrawCar(draft, n);
    btRigidBody* const chassis = AddChassis(draft, car);
    const btScalar hertz = draft->Draw(1.5, 4), omega = SIMD_2_PI * hertz;
    for (int i = 0; i < 4; ++i) {
      btRigidBody* const wheel = AddWheel(draft, car, i);
      const btTransform frame(btQuaternion::getIdentity(), wheel->getCenterOfMassPosition());
      auto* const joint = draft->Add(std::make_unique<btGeneric6DofSpringConstraint>(
          *chassis, *wheel, Local(*chassis, frame), Local(*wheel, frame), true));
      joint->setLinearLowerLimit(btVector3(0, btScalar(-0.2), 0));
      joint->setLinearUpperLimit(btVector3(0, btScalar(0.2), 0));
      joint->setAngularLowerLimit(btVector3(0, 0, 1));
      joint->setAngularUpperLimit(btVector3(0, 0, -1));
      joint->enableSpring(1, true);
      joint->setStiffness(1, car.mass / 4 * omega * omega);
      joint->setDamping(1, draft->Draw(0.3, 1));
      joint->setEquilibriumPoint(1);
      if (i < 2) continue;
      btRotationalLimitMotor* const motor = joint->getRotationalLimitMotor(2);
      motor->m_enableMotor = true;
      motor->m_targetVelocity = speed;
      motor->m_maxMotorForce = strength * car.mass * car.radius;
    }
  }
}

void DrawCart(Draft* draft) {
  AddRoad(draft);
  const int carts = draft->Count(1, 5);
  const btScalar speed = draft->Draw(-15, 15), strength = draft->DrawRatio(0.003, 0.1);
  Car car = DrawCar(draft, 0);
  btRigidBody* previous = nullptr;
  for (int n = 0; n < carts; ++n) {
    btRigidBody* const chassis = AddChassis(draft, car);
    for (int i = 0; i < 4; ++i) {
      btRigidBody* const wheel = AddWheel(draft, car, i);
      btHingeConstraint* const axle = Hinge(
          draft, chassis, wheel, FrameAlongZ(wheel->getCenterOfMassPosition(), btVector3(0, 0, 1)));
      if (n == 0) axle->enableAngularMotor(true, speed, strength * car.mass * car.radius);
    }
    const btScalar wheels = car.length * btScalar(0.8) + car.radius;
    const btScalar half = std::max(car.length, wheels) + btScalar(0.15);
    if (previous != nullptr) {
      const btVector3 coupling = car.at + btVector3(half, 0, 0);
      if (draft->Chance(0.5)) {
        Pin(draft, previous, chassis, coupling);
      } else {
        Hinge(draft, previous, chassis, FrameAlongZ(coupling, btVector3(0, 1, 0)));
      }
    }
    previous = chassis;
    car.at -= btVector3(2 * half, 0, 0);
  }
}

}  // namespace cairn::bench
