// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "cairn/contact_problem.h"

namespace cairn {

// A body with locked axes, as of a game in a plane, is pushed by a row along one of them through
// what rounding leaves of the other axes, or by a long detour: along a normal that leans by a
// degree it would have to go sixty times as far. Solved exactly, that flings it. So a row makes the
// steps of a body without locks, as Bullet does, and gets no further in a sweep; and where next to
// nothing of the push is left it does not move the body: it takes it for one of infinite mass.

/// Whether rows push it along some axes and not along others, or turn it about some alone. Axes
/// that it turns about are those of the world: a lock is a zero of Body::linear_factor, or on the
/// diagonal of Body::inv_inertia.
bool HasLockedAxes(const Body& body);

/// What locks make of one side of a row.
struct LockedSide {
  bool alone;  ///< The row does not move the body.
  /// What the body would answer along its locked axes [1/kg]: steps are 1 / (d + extra).
  double extra;
};
/// @param linear2, angular2  |J|^2 of its side of the row, of what pushes and of what turns
/// @param g  G = J R of that side
LockedSide LookAtLocked(const Body& body, double linear2, double angular2,
                        std::span<const double, 6> g);

}  // namespace cairn
