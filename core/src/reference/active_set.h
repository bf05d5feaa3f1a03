// SPDX-License-Identifier: MIT
#pragma once

#include "cairn/detail/memory.h"
#include "reference/pack.h"
#include "simd/pairs/pair_active_set.h"

namespace cairn {

using simd::RowSide;

/// The predicted set of one island, one entry per row.
using ActiveSet = Array<RowSide>;

/// The impulse a row has while it is not free.
inline double FixedImpulse(RowSide side, Bounds bounds) {
  return side == RowSide::kLo ? bounds.lo : bounds.hi;
}

/// Predicts from the natural map: x_i - w_i / d_i strictly inside the bounds is free, else the row
/// stays at that bound. Friction of a parent without impulse is fixed at zero. The paper takes
/// x_i > tol instead, which differs only in degenerate rows.
ActiveSet PredictActiveSet(const PackedIsland& island, const IslandState& state);

/// Removes free rows whose impulse left its bounds, to the bound they crossed. Returns how many.
/// Rows are never added: that is the work of the sweeps.
int RemoveViolated(const PackedIsland& island, const IslandState& state, ActiveSet* set);

}  // namespace cairn
