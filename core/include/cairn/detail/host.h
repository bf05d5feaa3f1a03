// SPDX-License-Identifier: MIT
// What only engines with habits of their own ask for (the Bullet adapter). No promise is made here.
#pragma once
#include "cairn/detail/cpp20.h"

#include <limits>

namespace cairn::detail {

class Threads;  // cairn/detail/threads.h

/// What a friction row does while its parent row pushes with nothing.
enum class LiftedFriction {
  kRelease,  ///< Its impulse is zero, as Coulomb says.
  kHold,     ///< It keeps its last impulse, as Bullet's sequential impulses do.
};

/// Of a row, or of all rows of a joint or manifold.
struct RowHost {
  /// Sweeps of a Solve() that it takes part in, counted from the first.
  int max_sweeps = std::numeric_limits<int>::max();
};

/// ContactImpulse::heading is the direction of t1 in the plane across the normal: where atan2 has
/// pi / 2 it has 2, and so on from 1 to 5; anything else is a t1 along the first axis of the plane.
/// A start is turned by it into directions of its own.

/// Of all contacts.
struct ContactHost {
  /// Friction sees the spin that bodies have before external torques act, as Bullet's does. Off:
  /// the one after.
  bool spin_before_torques = false;
  /// Friction along t2 has the bounds of t1 also where a point slides, as Bullet's two directions.
  /// Off: see ContactPoint.
  bool bounded_apart = false;
};

}  // namespace cairn::detail

namespace cairn {

/// The body index of what does not move: the ground, walls. What you move yourself (a platform, a
/// door) is a body with inv_mass 0 and a velocity: rows see how it moves, and do not change that.
inline constexpr int kWorld = -1;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// How a body moves before and after external impulses, where ContactProblem::motions says so.
struct ContactMotion {
  float free_velocity[3] = {}, free_spin[3] = {};    ///< With external impulses [m/s], [rad/s].
  float start_velocity[3] = {}, start_spin[3] = {};  ///< Before them.
};

}  // namespace cairn
