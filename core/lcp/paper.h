// SPDX-License-Identifier: MIT
#pragma once

#include "core/lcp/lcp_state.h"
#include "core/lcp/sparse_cholesky.h"

namespace cairn {

/// The algorithm of [1] (boxed_lcp.h) to the letter: k_gs sweeps, the set of rows further than tol
/// from their bounds, and up to k_sm reduced solves with projection and removal, until the residual
/// passes. Boxes instead of v >= 0 are our only addition: no safeguard. It may cycle or grow.
void RunPaper(LcpState* state, SparseCholesky* factor);

}  // namespace cairn
