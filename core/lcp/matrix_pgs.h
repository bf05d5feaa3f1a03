// SPDX-License-Identifier: MIT
#pragma once

#include "core/lcp/lcp_state.h"

namespace cairn {

/// Sweeps until the problem is solved or the budget spent: PGS and PSOR.
void RunSweeps(LcpState* state);

}  // namespace cairn
