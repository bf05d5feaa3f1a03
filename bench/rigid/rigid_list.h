// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "problems/problem.h"

namespace cairn::bench {

/// Problems in matrix form that need Bullet to make them:
/// - castle: the ten sizes and condition numbers of the talk (CastleSizes());
/// - castle-frame: all contacts of the castle in one frame.
/// The same call gives the same bits each time.
std::vector<problems::Generator> RigidGenerators();

}  // namespace cairn::bench
