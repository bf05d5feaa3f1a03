// SPDX-License-Identifier: MIT
// What pushes where in a Bullet world, as lines and dots: to be copied into an engine. The window
// of `cairn play` draws with it.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <algorithm>

namespace cairn::examples {

/// Implement two functions with whatever draws lines in your engine. Metres, world axes; colours
/// are 0xRRGGBB.
class DebugDraw {
 public:
  struct Point {
    float x, y, z;
  };
  virtual ~DebugDraw() = default;
  virtual void Line(const Point& from, const Point& to, unsigned colour) = 0;
  virtual void Dot(const Point& at, unsigned colour) = 0;
};

namespace detail {

inline constexpr unsigned kContact = 0xffd75e, kImpulse = 0x4cd964, kFriction = 0x5ac8fa,
                          kArm = 0xc7a6ff, kGap = 0xff453a;
inline constexpr btScalar kLengthOfWeight = btScalar(0.5), kLongest = btScalar(1.5);  // [m]

inline DebugDraw::Point ToPoint(const btVector3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// The mass of the lighter one that moves [kg].
inline btScalar Lighter(const btCollisionObject* a, const btCollisionObject* b) {
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

inline Anchors AnchorsOf(const btTypedConstraint& joint) {
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

}  // namespace detail

/// Points of contact, and what pushes there: a line as long as the impulse would lift the mass of
/// the lighter body in a step, times 0.5 m, at most 1.5 m; across it, friction likewise. Away from
/// what does not move.
inline void DrawContacts(const btDiscreteDynamicsWorld& world, btScalar time_step,
                         DebugDraw* draw) {
  using namespace detail;
  auto* const dispatcher = const_cast<btDispatcher*>(world.getDispatcher());
  const btScalar weight = world.getGravity().length() * time_step;
  if (weight <= 0) return;  // nothing to compare impulses with
  for (int i = 0; i < dispatcher->getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *dispatcher->getManifoldByIndexInternal(i);
    const btScalar mass = Lighter(manifold.getBody0(), manifold.getBody1());
    if (mass <= 0) continue;
    // on body 0, or on body 1 where 0 does not move
    const btScalar sign = manifold.getBody0()->isStaticOrKinematicObject() ? -1 : 1;
    const btScalar scale = kLengthOfWeight / (mass * weight);
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
      const btManifoldPoint& point = manifold.getContactPoint(k);
      const btVector3 at = point.getPositionWorldOnB();
      draw->Dot(ToPoint(at), kContact);
      const btScalar length = std::min(kLongest, scale * point.m_appliedImpulse);
      if (length > 0) {
        draw->Line(ToPoint(at), ToPoint(at + sign * length * point.m_normalWorldOnB), kImpulse);
      }
      const btVector3 lateral = point.m_appliedImpulseLateral1 * point.m_lateralFrictionDir1 +
                                point.m_appliedImpulseLateral2 * point.m_lateralFrictionDir2;
      const btScalar slide = std::min(kLongest, scale * lateral.length());
      if (slide > btScalar(1e-3)) {
        draw->Line(ToPoint(at), ToPoint(at + sign * slide * lateral.normalized()), kFriction);
      }
    }
  }
}

/// Joints: from each body to its anchor, and the gap between anchors in red.
inline void DrawJoints(const btDiscreteDynamicsWorld& world, DebugDraw* draw) {
  using namespace detail;
  for (int i = 0; i < world.getNumConstraints(); ++i) {
    const btTypedConstraint* const joint = world.getConstraint(i);
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

}  // namespace cairn::examples
