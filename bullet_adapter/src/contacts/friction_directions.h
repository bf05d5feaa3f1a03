// SPDX-License-Identifier: MIT
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include "cairn/bullet/precision.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// What bounds a second direction of friction.
enum class FrictionBounds {
  kOfSlide,  ///< Less where a point slides along the first one, see ContactPoint.
  kApart,    ///< The same as the first one, as Bullet.
};

/// What is written to a contact point together with its impulses, so that the next substep knows
/// along which directions the lateral ones were.
struct LeftDirections {
  /// 0: along btPlaneSpace1 of the normal; between 1 and 5: turned from it, and left-handed, as
  /// directions along the velocity are. It goes to btManifoldPoint::m_prevRHS, which solvers of
  /// rigid bodies do not use and which stays with the point when the narrow phase finds it again;
  /// the directions in the point are then overwritten, its impulses are not.
  btScalar heading = 0;
  int flags = 0;  ///< To be set in btManifoldPoint::m_contactPointFlags.
};

/// The directions of friction at a point.
struct FrictionDirections {
  btVector3 first{0, 0, 0}, second{0, 0, 0};  ///< The second only where there are two.
  /// btPlaneSpace1 of the normal, unless they are the user's.
  btVector3 plane_x{0, 0, 0}, plane_y{0, 0, 0};
  int count = 1;  ///< 1 or 2
  /// The speed along the first where the point slides so, 0 where friction is anisotropic [m/s].
  btScalar slide = 0;
  LeftDirections left;
  bool by_user = false;  ///< Set before the solver: with target speeds of their own.
  /// The same as in the substep before, so that impulses can be taken over as they are.
  bool as_left = false;
};

/// Scales a direction by the friction of an anisotropic object.
/// @param mode  of btCollisionObject::AnisotropicFrictionFlags
btVector3 Anisotropic(const btCollisionObject& object, int mode, const btVector3& direction);

/// Chooses the directions as Bullet does, and writes them to the point.
/// @param solver_mode  btContactSolverInfo::m_solverMode
/// @param velocity     of A relative to B at the point, with what forces add to it [m/s]
FrictionDirections ChooseDirections(int solver_mode, const btVector3& velocity,
                                    const btPersistentManifold& manifold, btManifoldPoint* point);

/// The impulse [N s] that friction left at a point, in world axes; its place in the plane of
/// contact is kept where the normal has turned since.
/// @param today  not the user's; if there is one direction, so was yesterday's
btVector3 LeftFriction(const btManifoldPoint& point, const FrictionDirections& today);

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
