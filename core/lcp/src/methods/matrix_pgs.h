// SPDX-License-Identifier: MIT
#pragma once

#include "lcp_state.h"

namespace cairn::lcp {

/// Sweeps until the problem is solved or the budget spent: PGS and PSOR.
void RunSweeps(LcpState* state);

}  // namespace cairn::lcp
