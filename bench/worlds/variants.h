// SPDX-License-Identifier: MIT
#pragma once

#include <btBulletDynamicsCommon.h>

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace cairn::bench {

/// A solver with its settings, made anew for each world.
struct Variant {
  std::string name, description;
  std::function<std::unique_ptr<btConstraintSolver>()> make;
  int iterations = 0;  ///< Instead of those of the world; 0: the world's.
};

/// Cairn as it comes, with sweeps only, with a budget of work, with a step wherever one may be.
std::span<const Variant> CairnVariants();

/// What they are measured against: Bullet with the iterations of the world, with 10, with 100.
std::span<const Variant> BulletVariants();

/// Bullet with 10,000 iterations, which solve nearly every world: motors, and joints with limits
/// about all axes, can make one wild that is solved that well, whoever does it.
const Variant& ConvergedBullet();

}  // namespace cairn::bench
