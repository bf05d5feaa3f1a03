// SPDX-License-Identifier: MIT
#include "reference/active_set.h"

#include <algorithm>
#include <cmath>

namespace cairn {
namespace {

/// How close to a bound counts as at the bound, relative to the mean impulse of the island.
constexpr double kActiveTolerance = 1e-9;

double ImpulseTolerance(const IslandState& state) {
  double sum = 0;
  for (double x : state.x) sum += std::abs(x);
  return state.x.empty() ? 0 : kActiveTolerance * sum / static_cast<double>(state.x.size());
}

/// The bounds of a row while its parent, if fixed, sits at its own bound.
Bounds PredictedBounds(const PackedIsland& island, const IslandState& state, const ActiveSet& set,
                       const PackedRow& row) {
  if (row.parent == kNoRow || set[row.parent] == RowSide::kFree) return BoundsOf(row, state.x);
  const PackedRow& parent = island.rows[row.parent];
  const double parent_x = FixedImpulse(set[row.parent], {parent.lo, parent.hi});
  const double most = row.friction * std::max(0.0, parent_x);
  return {std::max(-most, row.lo), std::min(most, row.hi)};
}

}  // namespace

ActiveSet PredictActiveSet(const PackedIsland& island, const IslandState& state) {
  const double tolerance = ImpulseTolerance(state);
  ActiveSet set(island.rows.size(), RowSide::kLo);
  for (size_t i = 0; i < island.rows.size(); ++i) {
    const PackedRow& row = island.rows[i];
    const Bounds bounds = PredictedBounds(island, state, set, row);
    if (row.diagonal <= 0 || bounds.hi - bounds.lo <= 2 * tolerance) continue;

    const double natural = state.x[i] - RelativeVelocity(row, state.u, state.x[i]) / row.diagonal;
    if (natural >= bounds.hi - tolerance) {
      set[i] = RowSide::kHi;
    } else if (natural > bounds.lo + tolerance) {
      set[i] = RowSide::kFree;
    }
  }
  return set;
}

int RemoveViolated(const PackedIsland& island, const IslandState& state, ActiveSet* set) {
  const double tolerance = ImpulseTolerance(state);
  int removed = 0;
  for (size_t i = 0; i < island.rows.size(); ++i) {
    RowSide& side = (*set)[i];
    if (side != RowSide::kFree) continue;
    const Bounds bounds = PredictedBounds(island, state, *set, island.rows[i]);
    // what is not a number leaves, too
    if (!(state.x[i] >= bounds.lo - tolerance)) {
      side = RowSide::kLo;
    } else if (state.x[i] > bounds.hi + tolerance) {
      side = RowSide::kHi;
    } else {
      continue;
    }
    ++removed;
  }
  return removed;
}

}  // namespace cairn
