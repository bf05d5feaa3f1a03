// SPDX-License-Identifier: MIT
#include "play/debug_draw.h"

#include <algorithm>

namespace cairn::play {
namespace {

constexpr unsigned kContact = 0xffd75e, kImpulse = 0x4cd964, kFriction = 0x5ac8fa, kArm = 0xc7a6ff,
                   kGap = 0xff453a;
constexpr btScalar kLengthOfWeight = btScalar(0.3), kLongest = btScalar(1.5);  // [m]

DebugDraw::Point ToPoint(const btVector3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// The mass of the lighter one that moves [kg].
btScalar Lighter(const btCollisionObject* a, const btCollisionObject* b) {
  btScalar mass = 0;
  for (const btCollisionObject* object : {a, b}) {
    const btRigidBody* const body = btRigidBody::upcast(object);
    if (body == nullptr || body->getMass() <= 0) continue;
    mass = mass == 0 ? body->getMass() : std::min(mass, body->getMass());
  }
  return mass;
}

struct Anchors {
  btVector3 a, b;
};

Anchors AnchorsOf(const btTypedConstraint& joint) {
  const btTransform &a = joint.getRigidBodyA().getCenterOfMassTransform(),
                    &b = joint.getRigidBodyB().getCenterOfMassTransform();
  switch (joint.getConstraintType()) {
    case POINT2POINT_CONSTRAINT_TYPE: {
      const auto& pin = static_cast<const btPoint2PointConstraint&>(joint);
      return {a * pin.getPivotInA(), b * pin.getPivotInB()};
    }
    case HINGE_CONSTRAINT_TYPE: {
      const auto& hinge = static_cast<const btHingeConstraint&>(joint);
      return {a * hinge.getAFrame().getOrigin(), b * hinge.getBFrame().getOrigin()};
    }
    case CONETWIST_CONSTRAINT_TYPE: {
      const auto& cone = static_cast<const btConeTwistConstraint&>(joint);
      return {a * cone.getAFrame().getOrigin(), b * cone.getBFrame().getOrigin()};
    }
    default: {
      // the others are drawn from body to body
      const btVector3 middle = (a.getOrigin() + b.getOrigin()) / 2;
      return {middle, middle};
    }
  }
}

}  // namespace

void DrawContacts(const bench::World& world, DebugDraw* draw) {
  auto* const dispatcher = const_cast<btDispatcher*>(world.bullet()->getDispatcher());
  const btScalar weight = btScalar(9.81) * world.time_step();
  for (int i = 0; i < dispatcher->getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *dispatcher->getManifoldByIndexInternal(i);
    const btScalar mass = Lighter(manifold.getBody0(), manifold.getBody1());
    if (mass <= 0) continue;
    const btScalar scale = kLengthOfWeight / (mass * weight);
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
      const btManifoldPoint& point = manifold.getContactPoint(k);
      const btVector3 at = point.getPositionWorldOnB();
      draw->Dot(ToPoint(at), kContact);
      const btScalar length = std::min(kLongest, scale * point.m_appliedImpulse);
      if (length > 0) {
        draw->Line(ToPoint(at), ToPoint(at + length * point.m_normalWorldOnB), kImpulse);
      }
      const btVector3 along = point.m_appliedImpulseLateral1 * point.m_lateralFrictionDir1 +
                              point.m_appliedImpulseLateral2 * point.m_lateralFrictionDir2;
      const btScalar slide = std::min(kLongest, scale * along.length());
      if (slide > btScalar(1e-3)) {
        draw->Line(ToPoint(at), ToPoint(at + slide * along.normalized()), kFriction);
      }
    }
  }
}

void DrawJoints(const bench::World& world, DebugDraw* draw) {
  for (const btTypedConstraint* joint : world.joints()) {
    const Anchors anchors = AnchorsOf(*joint);
    const btRigidBody &a = joint->getRigidBodyA(), &b = joint->getRigidBodyB();
    draw->Dot(ToPoint(anchors.a), kArm);
    if (a.getMass() > 0) {
      draw->Line(ToPoint(a.getCenterOfMassPosition()), ToPoint(anchors.a), kArm);
    }
    if (b.getMass() > 0) {
      draw->Line(ToPoint(b.getCenterOfMassPosition()), ToPoint(anchors.b), kArm);
    }
    draw->Line(ToPoint(anchors.a), ToPoint(anchors.b), kGap);
  }
}

}  // namespace cairn::play
