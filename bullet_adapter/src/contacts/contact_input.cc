// SPDX-License-Identifier: MIT
#include "contacts/contact_input.h"

#include "conversions.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

/// Rolling friction that is anisotropic enough to be none has no row.
constexpr btScalar kLeastAxis = btScalar(0.001);

/// What all points of a manifold share.
struct Sides {
  const btPersistentManifold& manifold;
  btVector3 origin_a, origin_b;
  /// With what forces add over the step; zero for what has no number.
  btVector3 velocity_a, spin_a, velocity_b, spin_b;
  btScalar pushed = 0;  ///< What forces add to the speed of a body, the larger of both [m/s].
};

Sides ReadSides(const btPersistentManifold& manifold, const ManifoldInput& numbers,
                const BodyTable& bodies) {
  const btVector3 zero(0, 0, 0);
  Sides sides{manifold,
              manifold.getBody0()->getWorldTransform().getOrigin(),
              manifold.getBody1()->getWorldTransform().getOrigin(),
              zero,
              zero,
              zero,
              zero};
  if (numbers.body_a != kWorld) {
    const Motion& motion = bodies.motion(numbers.body_a);
    sides.velocity_a = motion.velocity + motion.external_velocity;
    sides.spin_a = motion.spin + motion.external_spin;
    sides.pushed = motion.external_velocity.length();
  }
  if (numbers.body_b != kWorld) {
    const Motion& motion = bodies.motion(numbers.body_b);
    sides.velocity_b = motion.velocity + motion.external_velocity;
    sides.spin_b = motion.spin + motion.external_spin;
    sides.pushed = btMax(sides.pushed, motion.external_velocity.length());
  }
  return sides;
}

void ReadFriction(const Sides& sides, const btContactSolverInfo& info, FrictionBounds bounds,
                  ContactInput* input) {
  btManifoldPoint& point = *input->point;
  const btVector3 velocity = sides.velocity_a + sides.spin_a.cross(input->arm_a) -
                             (sides.velocity_b + sides.spin_b.cross(input->arm_b));
  const FrictionDirections directions =
      ChooseDirections(info.m_solverMode, velocity, sides.manifold, &point);
  input->tangents[0] = directions.first;
  input->tangents[1] = directions.second;
  input->left = directions.left;
  const btScalar friction = btMax(btScalar(0), point.m_combinedFriction);
  input->friction[0] = input->friction[1] = friction;
  if (directions.slide > 0 && bounds == FrictionBounds::kOfSlide) {
    const btScalar stopped = friction * btMax(-input->normal.dot(velocity), sides.pushed);
    input->friction[1] *= btMin(btScalar(1), stopped / directions.slide);
  }
  input->slip = directions.by_user ? point.m_frictionCFM : btScalar(0);
  input->tangent_speeds[0] = directions.by_user ? point.m_contactMotion1 : btScalar(0);
  input->tangent_speeds[1] = directions.by_user ? point.m_contactMotion2 : btScalar(0);
  if ((point.m_contactPointFlags & BT_CONTACT_FLAG_FRICTION_ANCHOR) != 0) {
    const btVector3 drift = point.getPositionWorldOnA() - point.getPositionWorldOnB();
    for (int k = 0; k < 2; ++k) {
      input->tangent_speeds[k] -=
          drift.dot(input->tangents[k]) * info.m_frictionERP / info.m_timeStep;
    }
  }
  input->tangent_impulses[0] = point.m_appliedImpulseLateral1;
  input->tangent_impulses[1] = point.m_appliedImpulseLateral2;
  const bool none = point.m_appliedImpulseLateral1 == 0 && point.m_appliedImpulseLateral2 == 0;
  if (directions.as_left || none) return;
  const btVector3 left = LeftFriction(point, directions);
  for (int k = 0; k < directions.count; ++k) {
    const btScalar length2 = input->tangents[k].length2();
    input->tangent_impulses[k] = length2 > 0 ? left.dot(input->tangents[k]) / length2 : btScalar(0);
  }
}

void AddTwist(const btVector3& axis, btScalar limit, ContactInput* input) {
  input->twist_axes[input->twists] = axis;
  input->twist_limits[input->twists] = btMax(btScalar(0), limit);
  ++input->twists;
}

/// Spinning friction counts only together with rolling friction, as in Bullet.
void ReadTwists(const btPersistentManifold& manifold, ContactInput* input) {
  input->twists = 0;
  const btManifoldPoint& point = *input->point;
  if (!(point.m_combinedRollingFriction > 0)) return;
  AddTwist(input->normal, point.m_combinedSpinningFriction, input);
  btVector3 axes[2];
  btPlaneSpace1(input->normal, axes[0], axes[1]);
  for (const btVector3& axis : axes) {
    constexpr int kMode = btCollisionObject::CF_ANISOTROPIC_ROLLING_FRICTION;
    const btVector3 scaled = Anisotropic(
        *manifold.getBody1(), kMode, Anisotropic(*manifold.getBody0(), kMode, axis.normalized()));
    if (scaled.length() > kLeastAxis) AddTwist(scaled, point.m_combinedRollingFriction, input);
  }
}

/// Sets the start of what resists rolling, and scales that of the rest.
void Start(const ContactStart& start, ContactInput* input) {
  input->normal_impulse *= start.normal;
  for (btScalar& impulse : input->tangent_impulses) impulse *= start.friction;
  input->twist_impulses = {};
  if (input->twists == 0 || start.twists == nullptr) return;
  input->twist_impulses = start.twists->Find(*input->point);
  for (btScalar& impulse : input->twist_impulses) impulse *= start.friction;
}

void ReadPoint(const Sides& sides, const btContactSolverInfo& info, FrictionBounds bounds,
               const Softness& softness, ContactInput* input) {
  const btManifoldPoint& point = *input->point;
  input->arm_a = point.getPositionWorldOnA() - sides.origin_a;
  input->arm_b = point.getPositionWorldOnB() - sides.origin_b;
  input->normal = point.m_normalWorldOnB;
  input->distance = point.getDistance() + softness.slop;
  input->restitution = point.m_combinedRestitution;
  input->normal_impulse = point.m_appliedImpulse;
  input->softness = softness;
  ReadFriction(sides, info, bounds, input);
  ReadTwists(sides.manifold, input);
}

}  // namespace

void ReadManifold(btPersistentManifold* manifold, const btContactSolverInfo& info,
                  FrictionBounds bounds, const ContactSoftness& softness, const ContactStart& start,
                  BodyTable* bodies, ManifoldInput* result) {
  result->points = 0;
  if (manifold->getNumContacts() == 0) return;
  const ContactEnd a = bodies->EndOf(*manifold->getBody0());
  const ContactEnd b = bodies->EndOf(*manifold->getBody1());
  if (!a.reacts && !b.reacts) return;
  result->body_a = a.number;
  result->body_b = b.number;
  result->tangents = (info.m_solverMode & SOLVER_USE_2_FRICTION_DIRECTIONS) != 0 ? 2 : 1;

  const Sides sides = ReadSides(*manifold, *result, *bodies);
  const Softness common = softness.Of(*manifold);
  const btScalar threshold = manifold->getContactProcessingThreshold();
  for (int i = 0; i < manifold->getNumContacts(); ++i) {
    btManifoldPoint& point = manifold->getContactPoint(i);
    if (!(point.getDistance() <= threshold)) continue;
    ContactInput& input = result->inputs[result->points++];
    input.point = &point;
    ReadPoint(sides, info, bounds, softness.Of(point, common), &input);
    Start(start, &input);
  }
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
