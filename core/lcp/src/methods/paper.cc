// SPDX-License-Identifier: MIT
#include "methods/paper.h"

#include <algorithm>

#include "methods/face.h"

namespace cairn::lcp {
namespace {

/// Takes out of the set the free rows within tol of a bound or beyond it. Returns how many.
int Remove(const RowSet& reached, RowSet* set) {
  int removed = 0;
  for (size_t i = 0; i < set->size(); ++i) {
    if ((*set)[i] != Side::kFree || reached[i] == Side::kFree) continue;
    (*set)[i] = reached[i];
    ++removed;
  }
  return removed;
}

}  // namespace

void RunPaper(LcpState* state, SparseCholesky* factor) {
  const BoxedLcp& problem = state->problem();
  const Settings& settings = state->settings();
  FaceSolver face(state, factor);
  while (!state->done()) {
    state->SweepTimes(settings.k_gs);
    state->Judge();
    if (state->done()) break;

    RowSet set = SetByDistance(problem, state->x, settings.active_tolerance);
    for (int k = 0; k < settings.k_sm && !state->done(); ++k) {
      if (!face.Fits(set)) break;
      if (!face.SolveExactly(set, &state->x)) {
        return state->Fail();
      }
      const RowSet reached = SetByDistance(problem, state->x, settings.active_tolerance);
      const int removed = Remove(reached, &set);
      Clamp(problem, &state->x);
      state->Show();
      if (removed == 0) break;
    }
    state->Judge();
  }
}

}  // namespace cairn::lcp
