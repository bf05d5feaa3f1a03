// SPDX-License-Identifier: MIT
#include "pgs/row_sweep.h"

#include <algorithm>
#include <cmath>

namespace cairn {

double SweepRows(const PackedIsland& island, SweepRange range, LiftedFriction lifted,
                 IslandState* state) {
  double largest = 0;
  for (int i = range.begin; i < range.end; ++i) {
    const PackedRow& row = island.rows[i];
    if (range.sweep >= row.max_sweeps) continue;
    const bool is_lifted = row.parent != kNoRow && !(state->x[row.parent] > 0);
    if (is_lifted && lifted == LiftedFriction::kHold) continue;

    // relax the row alone, then back inside its bounds:  x := clamp(x - w / d)
    const double old = state->x[i];
    const double w = Slack(row, state->u, old);
    const double x = Clamp(old - row.step * w, BoundsOf(row, state->x));
    const double change = x - old;
    state->x[i] = x;

    // u += G' change
    AddScaled(row.g_a, change, &state->u[row.a]);
    AddScaled(row.g_b, change, &state->u[row.b]);
    largest = std::max(largest, row.diagonal * std::abs(change));
  }
  return largest;
}

}  // namespace cairn
