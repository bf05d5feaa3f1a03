// SPDX-License-Identifier: MIT
#include "reference/row_sweep.h"

#include <algorithm>
#include <cmath>

namespace cairn {
namespace {

/// The row keeps its impulse in this sweep.
bool Rests(const PackedRow& row, int sweep, detail::LiftedFriction lifted,
           const IslandState& state) {
  if (sweep >= row.max_sweeps) return true;
  const bool is_lifted = row.parent != kNoRow && !(state.x[row.parent] > 0);
  return is_lifted && lifted == detail::LiftedFriction::kHold;
}

/// x_i := x,  u += G' (change of x_i). Returns the change.
double Set(const PackedRow& row, int i, double x, IslandState* state) {
  const double change = x - state->x[i];
  state->x[i] = x;
  AddScaled(row.g_a, change, &state->u[row.a]);
  AddScaled(row.g_b, change, &state->u[row.b]);
  return change;
}

}  // namespace

double SweepRows(const PackedIsland& island, SweepRange range, detail::LiftedFriction lifted,
                 IslandState* state) {
  double largest = 0;
  for (int i = range.begin; i < range.end; ++i) {
    const PackedRow& row = island.rows[i];
    if (Rests(row, range.sweep, lifted, *state)) continue;

    // relax the row alone, then back inside its bounds:  x := clamp(x - w / d)
    const double old = state->x[i];
    const double w = RelativeVelocity(row, state->u, old);
    const double change = Set(row, i, Clamp(old - row.step * w, BoundsOf(row, state->x)), state);
    largest = std::max(largest, row.diagonal * std::abs(change));
  }
  return largest;
}

void ProjectFriction(const PackedIsland& island, SweepRange range, detail::LiftedFriction lifted,
                     IslandState* state) {
  for (int i = range.begin; i < range.end; ++i) {
    const PackedRow& row = island.rows[i];
    if (row.parent == kNoRow || Rests(row, range.sweep, lifted, *state)) continue;
    Set(row, i, Clamp(state->x[i], BoundsOf(row, state->x)), state);
  }
}

}  // namespace cairn
