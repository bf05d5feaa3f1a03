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

/// Relaxes the row alone, then back inside its bounds:  x := clamp(x - w / d). Returns the change.
double Relax(const PackedRow& row, int i, IslandState* state) {
  const double old = state->x[i];
  const double w = RelativeVelocity(row, state->u, old);
  return Set(row, i, Clamp(old - row.step * w, BoundsOf(row, state->x)), state);
}

}  // namespace

double SweepRows(const PackedIsland& island, SweepRange range, detail::LiftedFriction lifted,
                 IslandState* state) {
  double largest = 0;
  for (int i = range.begin; i < range.end; ++i) {
    const PackedRow& row = island.rows[i];
    if (Rests(row, range.sweep, lifted, *state)) continue;
    largest = std::max(largest, row.diagonal * std::abs(Relax(row, i, state)));
  }
  return largest;
}

void SweepFriction(const PackedIsland& island, int sweep, detail::LiftedFriction lifted,
                   IslandState* state) {
  for (int i = 0; i < static_cast<int>(island.rows.size()); ++i) {
    const PackedRow& row = island.rows[i];
    if (row.parent != kNoRow && !Rests(row, sweep, lifted, *state)) Relax(row, i, state);
  }
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
