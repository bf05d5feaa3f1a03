// SPDX-License-Identifier: MIT
#pragma once

#include <btBulletDynamicsCommon.h>

#include "animation/animation.h"

namespace cairn::cli {

/// A shape without parts as it is drawn; its box of bounds where there is no picture of it.
AnimatedShape ToAnimatedShape(const btCollisionShape& shape);

/// From the axis of a cylinder or capsule to y; and to the middle of what is drawn as its box.
btTransform AxisOf(const btCollisionShape& shape);

}  // namespace cairn::cli
