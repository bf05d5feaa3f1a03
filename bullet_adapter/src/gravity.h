// SPDX-License-Identifier: MIT
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <span>

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// How a world accelerates an object, in its units of length a s^2; 0 if it does not.
btScalar GravityOf(const btCollisionObject* object);

/// Units of length in a metre, if those of the first bodies that fall fastest do so as on Earth: a
/// power of two, so that numbers times it keep their digits. 1 for gravities of 6.94 to 13.8, and
/// where none of the first bodies falls.
double UnitsPerMetre(std::span<btCollisionObject* const> bodies);

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
