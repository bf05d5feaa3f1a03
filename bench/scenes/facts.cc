// SPDX-License-Identifier: MIT
#include "scenes/facts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace cairn::bench {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// The point of a joint that each of its two bodies should hold in the same place, in their frames.
struct Anchors {
  btVector3 in_a, in_b;
};

template <class SixDof>
std::optional<Anchors> LockedAnchors(const btTypedConstraint& joint) {
  // Bullet's getters of limits are not const, yet change nothing.
  auto& locked = const_cast<SixDof&>(static_cast<const SixDof&>(joint));
  btVector3 lower, upper;
  locked.getLinearLowerLimit(lower);
  locked.getLinearUpperLimit(upper);
  if (!lower.isZero() || !upper.isZero()) return std::nullopt;
  return Anchors{locked.getFrameOffsetA().getOrigin(), locked.getFrameOffsetB().getOrigin()};
}

std::optional<Anchors> FindAnchors(const btTypedConstraint& joint) {
  switch (joint.getConstraintType()) {
    case POINT2POINT_CONSTRAINT_TYPE: {
      const auto& pin = static_cast<const btPoint2PointConstraint&>(joint);
      return Anchors{pin.getPivotInA(), pin.getPivotInB()};
    }
    case HINGE_CONSTRAINT_TYPE: {
      const auto& hinge = static_cast<const btHingeConstraint&>(joint);
      return Anchors{hinge.getAFrame().getOrigin(), hinge.getBFrame().getOrigin()};
    }
    case CONETWIST_CONSTRAINT_TYPE: {
      const auto& cone = static_cast<const btConeTwistConstraint&>(joint);
      return Anchors{cone.getAFrame().getOrigin(), cone.getBFrame().getOrigin()};
    }
    case D6_CONSTRAINT_TYPE:
    case D6_SPRING_CONSTRAINT_TYPE:
      return LockedAnchors<btGeneric6DofConstraint>(joint);
    case D6_SPRING_2_CONSTRAINT_TYPE:
    case FIXED_CONSTRAINT_TYPE:
      return LockedAnchors<btGeneric6DofSpring2Constraint>(joint);
    default:
      return std::nullopt;
  }
}

/// Folds the gaps of the joints that have one.
template <class Fold>
double FoldJointGaps(const World& world, Fold fold) {
  double result = kNone;
  for (const btTypedConstraint* joint : world.joints()) {
    const double gap = JointGap(*joint);
    if (!std::isnan(gap)) result = std::isnan(result) ? gap : fold(result, gap);
  }
  return result;
}

void HashBytes(const btScalar* values, size_t count, std::uint64_t* hash) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(values);
  for (size_t i = 0; i < count * sizeof(btScalar); ++i) {
    *hash = (*hash ^ bytes[i]) * 0x100000001b3u;
  }
}

/// Without the fourth component, which Bullet leaves undefined.
void HashVector(const btVector3& vector, std::uint64_t* hash) {
  HashBytes(vector.m_floats, 3, hash);
}

template <class Visit>
void ForEachManifold(const World& world, Visit visit) {
  const btDispatcher* dispatcher = world.bullet()->getDispatcher();
  for (int i = 0; i < dispatcher->getNumManifolds(); ++i) {
    // Const access is missing from Bullet's interface of dispatchers.
    visit(*const_cast<btDispatcher*>(dispatcher)->getManifoldByIndexInternal(i));
  }
}

}  // namespace

double MaxPenetration(const World& world) {
  double deepest = 0;
  ForEachManifold(world, [&](const btPersistentManifold& manifold) {
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
      deepest = std::max(deepest, -static_cast<double>(manifold.getContactPoint(k).getDistance()));
    }
  });
  return deepest;
}

double FrictionTwist(const World& world) {
  double sum = 0;
  ForEachManifold(world, [&](const btPersistentManifold& manifold) {
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
      const btManifoldPoint& point = manifold.getContactPoint(k);
      const btVector3 apart = point.getPositionWorldOnA() - point.getPositionWorldOnB();
      sum += static_cast<double>(apart.length()) *
             std::hypot(point.m_appliedImpulseLateral1, point.m_appliedImpulseLateral2);
    }
  });
  return sum;
}

int ContactPoints(const World& world) {
  int points = 0;
  ForEachManifold(
      world, [&](const btPersistentManifold& manifold) { points += manifold.getNumContacts(); });
  return points;
}

double JointGap(const btTypedConstraint& joint) {
  const std::optional<Anchors> anchors = FindAnchors(joint);
  if (!anchors) return kNone;
  const btVector3 a = joint.getRigidBodyA().getCenterOfMassTransform() * anchors->in_a;
  const btVector3 b = joint.getRigidBodyB().getCenterOfMassTransform() * anchors->in_b;
  return (a - b).length();
}

double LargestJointGap(const World& world) {
  return FoldJointGaps(world, [](double a, double b) { return std::max(a, b); });
}

double TotalJointGap(const World& world) {
  return FoldJointGaps(world, [](double a, double b) { return a + b; });
}

double LargestSpeed(const World& world) {
  double largest = 0;
  for (const btRigidBody* body : world.dynamic_bodies()) {
    const double speed = body->getLinearVelocity().length();
    // A comparison that fails for NaN would hide it.
    if (!(speed <= largest)) largest = speed;
  }
  return largest;
}

double TopHeight(const World& world) {
  double top = -std::numeric_limits<double>::infinity();
  for (const btRigidBody* body : world.dynamic_bodies()) {
    top = std::max(top, static_cast<double>(body->getCenterOfMassPosition().y()));
  }
  return top;
}

double TotalMass(const World& world) {
  double mass = 0;
  for (const btRigidBody* body : world.dynamic_bodies()) mass += body->getMass();
  return mass;
}

double TotalEnergy(const World& world) {
  const btVector3 gravity = world.bullet()->getGravity();
  double energy = 0;
  for (const btRigidBody* body : world.dynamic_bodies()) {
    const btMatrix3x3& basis = body->getCenterOfMassTransform().getBasis();
    const btVector3 spin = basis.transpose() * body->getAngularVelocity();
    const btVector3 inertia = body->getLocalInertia();
    energy += 0.5 * body->getMass() * body->getLinearVelocity().length2() +
              0.5 * (inertia * spin).dot(spin) -
              body->getMass() * gravity.dot(body->getCenterOfMassPosition());
  }
  return energy;
}

IslandFacts FactsOfIsland(const World& world, int body) {
  const btRigidBody& first = *world.dynamic_bodies()[body];
  const auto inside = [&first](const btCollisionObject& object) {
    return !object.isStaticOrKinematicObject() && object.getIslandTag() == first.getIslandTag();
  };
  IslandFacts facts;
  facts.asleep = !first.isActive();
  for (const btRigidBody* other : world.dynamic_bodies()) {
    if (!inside(*other)) continue;
    ++facts.bodies;
    facts.mass += other->getMass();
    facts.speed = std::max<double>(facts.speed, other->getLinearVelocity().length());
  }
  for (const btTypedConstraint* joint : world.joints()) {
    if (!inside(joint->getRigidBodyA()) && !inside(joint->getRigidBodyB())) continue;
    ++facts.joints;
    const double gap = JointGap(*joint);
    if (gap > facts.joint_gap) facts.joint_gap = gap;
  }
  ForEachManifold(world, [&](const btPersistentManifold& manifold) {
    if (!inside(*manifold.getBody0()) && !inside(*manifold.getBody1())) return;
    facts.contacts += manifold.getNumContacts();
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
      facts.penetration =
          std::max<double>(facts.penetration, -manifold.getContactPoint(k).getDistance());
    }
  });
  return facts;
}

std::uint64_t StateHash(const World& world) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const btRigidBody* body : world.dynamic_bodies()) {
    const btTransform& pose = body->getCenterOfMassTransform();
    HashVector(pose.getOrigin(), &hash);
    for (int row = 0; row < 3; ++row) HashVector(pose.getBasis()[row], &hash);
    HashVector(body->getLinearVelocity(), &hash);
    HashVector(body->getAngularVelocity(), &hash);
  }
  return hash;
}

}  // namespace cairn::bench
