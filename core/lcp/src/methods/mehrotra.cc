// SPDX-License-Identifier: MIT
#include <algorithm>

#include "methods/barrier.h"

namespace cairn::lcp {

void RunInteriorPoint(LcpState* state, SparseCholesky* factor) {
  // a start near the solution is worth more than a few sweeps cost
  state->SweepTimes(state->settings().k_gs);
  state->Judge();
  if (state->done()) return;

  Barrier barrier(state, factor, state->x);
  while (!state->done()) {
    if (!barrier.Fits()) {
      state->EndForBudget();
      break;
    }
    if (!barrier.Step()) return state->Fail();
    // near the end a row is better off at the bound than a rounding away from it
    state->x = barrier.x();
    const double inner = state->Judge();
    if (!state->done()) state->x = barrier.Rounded();
    const double rounded = state->Judge();
    state->Show();

    if (!barrier.Advances(std::min(inner, rounded))) state->End(StopReason::kStalled);
  }
}

}  // namespace cairn::lcp
