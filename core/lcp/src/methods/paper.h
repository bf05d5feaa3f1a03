// SPDX-License-Identifier: MIT
#pragma once

#include "lcp_state.h"
#include "methods/sparse_cholesky.h"

namespace cairn::lcp {

/// The algorithm of [1] (cairn/lcp/problem.h) to the letter: k_gs sweeps, the set of rows further
/// than tol from their bounds, and up to k_sm reduced solves with projection and removal, until the
/// residual passes. Boxes instead of v >= 0 are our only addition: no safeguard. It may cycle or
/// grow.
void RunPaper(LcpState* state, SparseCholesky* factor);

}  // namespace cairn::lcp
