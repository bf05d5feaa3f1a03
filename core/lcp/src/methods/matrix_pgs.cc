// SPDX-License-Identifier: MIT
#include "methods/matrix_pgs.h"

#include <cmath>

namespace cairn::lcp {

void RunSweeps(LcpState* state) {
  const Settings& settings = state->settings();
  while (!state->done()) {
    if (state->sweeps() >= settings.max_sweeps) {
      state->End(StopReason::kSweepLimit);
      break;
    }
    const double moved = state->Sweep();
    state->Show();
    // sweeps of a positive definite matrix cannot grow
    if (!std::isfinite(moved)) return state->Fail();
    // measuring costs a sweep: only where the rows have all but stopped
    if (moved <= settings.tolerance) state->Judge();
    if (moved * state->scale() <= settings.min_progress) state->End(StopReason::kStationary);
  }
  // sweeps lower the objective, so the last iterate is the best one
  state->Judge();
}

}  // namespace cairn::lcp
