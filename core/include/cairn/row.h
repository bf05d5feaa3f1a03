// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include "cairn/detail/host.h"
#include "cairn/vector.h"

namespace cairn {

/// The parent of a row that has bounds of its own.
inline constexpr int kNoRow = -1;

/// One scalar constraint between two bodies. Its impulse x [N s] (or [N m s] if the row only turns)
/// and its relative velocity
///   w = J v + compliance x - target                                  [m/s] or [rad/s]
/// obey: w >= 0 where x = lo, w <= 0 where x = hi, w = 0 in between. A contact has lo = 0 and
/// hi = infinity, a joint has no bounds. A row with a parent is friction: its bounds are
/// +-friction max(0, x_parent), cut down to [lo, hi] (lo <= 0 <= hi).
struct Row {
  int body_a = kWorld, body_b = kWorld;
  /// The 12 entries of J: w gains linear_a . v_a + angular_a . omega_a + (the same for b).
  Vector3 linear_a = {}, angular_a = {}, linear_b = {}, angular_b = {};
  double target = 0;                       ///< [m/s] or [rad/s]
  double compliance = 0;                   ///< E, the diagonal added to J M^-1 J' [1/kg], >= 0.
  double lo = -kInfinity, hi = kInfinity;  ///< [N s] or [N m s], lo <= hi.
  int parent = kNoRow;    ///< Earlier row of the same two bodies that bounds this one.
  double friction = 0;    ///< Coefficient against the parent, >= 0.
  double relaxation = 1;  ///< Step length of this row in a sweep, in (0, 2).
  detail::RowHost host = {};
};

}  // namespace cairn
