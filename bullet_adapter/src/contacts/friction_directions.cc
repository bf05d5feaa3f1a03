// SPDX-License-Identifier: MIT
#include "contacts/friction_directions.h"

#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <LinearMath/btVector3.h>

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

/// A direction in a plane as a number that needs no trigonometry: its place on the square
/// |x| + |y| = 1, from 1 at (1, 0) counter-clockwise to 5.
btScalar ToHeading(btScalar x, btScalar y) {
  const btScalar sum = btFabs(x) + btFabs(y);
  if (!(sum > 0)) return 1;
  const btScalar along = x / sum;
  return y >= 0 ? 2 - along : 4 + along;
}

struct PlaneVector {
  btScalar x, y;
};

PlaneVector FromHeading(btScalar heading) {
  const btScalar x = heading < 3 ? 2 - heading : heading - 4;
  const btScalar y = heading < 3 ? 1 - btFabs(x) : btFabs(x) - 1;
  const btScalar inverse_length = 1 / btSqrt(x * x + y * y);
  return {x * inverse_length, y * inverse_length};
}

constexpr int kSlides = btCollisionObject::CF_ANISOTROPIC_FRICTION;

bool IsAnisotropic(const btPersistentManifold& manifold) {
  return manifold.getBody0()->hasAnisotropicFriction(kSlides) ||
         manifold.getBody1()->hasAnisotropicFriction(kSlides);
}

btVector3 AnisotropicForBoth(const btPersistentManifold& manifold, const btVector3& direction) {
  return Anisotropic(*manifold.getBody1(), kSlides,
                     Anisotropic(*manifold.getBody0(), kSlides, direction));
}

}  // namespace

btVector3 Anisotropic(const btCollisionObject& object, int mode, const btVector3& direction) {
  if (!object.hasAnisotropicFriction(mode)) return direction;
  const btMatrix3x3& axes = object.getWorldTransform().getBasis();
  return axes * (direction * axes * object.getAnisotropicFriction());
}

FrictionDirections ChooseDirections(int solver_mode, const btVector3& velocity,
                                    const btPersistentManifold& manifold, btManifoldPoint* point) {
  FrictionDirections result;
  const bool both = (solver_mode & SOLVER_USE_2_FRICTION_DIRECTIONS) != 0;
  result.count = both ? 2 : 1;
  const bool by_velocity =
      (solver_mode & SOLVER_DISABLE_VELOCITY_DEPENDENT_FRICTION_DIRECTION) == 0;
  if ((solver_mode & SOLVER_ENABLE_FRICTION_DIRECTION_CACHING) != 0 &&
      (point->m_contactPointFlags & BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED) != 0) {
    result.first = point->m_lateralFrictionDir1;
    result.second = point->m_lateralFrictionDir2;
    result.left.heading = point->m_prevRHS;
    result.by_user = result.as_left = true;
    return result;
  }

  const btVector3& normal = point->m_normalWorldOnB;
  btPlaneSpace1(normal, result.plane_x, result.plane_y);
  const btVector3 lateral = velocity - normal * normal.dot(velocity);
  const btScalar speed2 = lateral.length2();
  if (by_velocity && speed2 > SIMD_EPSILON) {
    const btScalar speed = btSqrt(speed2);
    if (!IsAnisotropic(manifold)) result.slide = speed;
    const btVector3 unit = lateral * (1 / speed);
    result.left.heading = ToHeading(unit.dot(result.plane_x), unit.dot(result.plane_y));
    point->m_lateralFrictionDir1 = result.first = AnisotropicForBoth(manifold, unit);
    if (!both) return result;
    result.second = AnisotropicForBoth(manifold, result.first.cross(normal).normalized());
    point->m_lateralFrictionDir2 = result.second;
    return result;
  }

  result.first = AnisotropicForBoth(manifold, result.plane_x);
  result.second = both ? AnisotropicForBoth(manifold, result.plane_y) : result.plane_y;
  result.as_left = point->m_prevRHS == 0;
  if (both && !by_velocity) result.left.flags = BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED;
  point->m_lateralFrictionDir1 = result.first;
  point->m_lateralFrictionDir2 = result.second;
  return result;
}

btVector3 LeftFriction(const btManifoldPoint& point, const FrictionDirections& today) {
  const btScalar first = point.m_appliedImpulseLateral1;
  const btScalar second = today.count > 1 ? point.m_appliedImpulseLateral2 : btScalar(0);
  if (!(point.m_prevRHS >= 1 && point.m_prevRHS <= 5)) {
    return today.plane_x * first + today.plane_y * second;
  }
  const PlaneVector along = FromHeading(point.m_prevRHS);
  return today.plane_x * (along.x * first + along.y * second) +
         today.plane_y * (along.y * first - along.x * second);
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
