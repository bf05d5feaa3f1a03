// SPDX-License-Identifier: MIT
#pragma once

#include "cairn/settings.h"
#include "reference/pack.h"

namespace cairn {

/// Which rows to relax, in which sweep of the Solve().
struct SweepRange {
  int begin, end;  ///< rows of the island
  int sweep;       ///< sweeps made before this one
};

/// Projected Gauss-Seidel over a range of rows, in their order. Returns the largest velocity that a
/// row was moved by, d |change of x| [m/s] or [rad/s].
double SweepRows(const PackedIsland& island, SweepRange range, detail::LiftedFriction lifted,
                 IslandState* state);

/// The same over all rows that have a parent, and no others.
void SweepFriction(const PackedIsland& island, int sweep, detail::LiftedFriction lifted,
                   IslandState* state);

/// Brings friction back inside its bounds, in rows that a sweep did not get to after it had changed
/// their parents.
void ProjectFriction(const PackedIsland& island, SweepRange range, detail::LiftedFriction lifted,
                     IslandState* state);

}  // namespace cairn
