// SPDX-License-Identifier: MIT
#pragma once

#include "lcp_state.h"
#include "methods/sparse_cholesky.h"

namespace cairn::lcp {

/// The algorithm of the paper made robust. Sweeps and reduced solves take turns as there, but
///   - a row outside the set joins it when its w has the wrong sign, not only a sweep later;
///   - a singular reduced matrix gets a proximal term, refined away;
///   - the set has to settle: once its changes stop shrinking, iterations of the interior point
///     method predict it, and reduced solves finish from there;
///   - the best iterate is kept.
/// Without such a set (mass ratios, walls, see docs/paper.md) the literal algorithm cycles.
void RunSetSearch(LcpState* state, SparseCholesky* reduced, SparseCholesky* whole);

}  // namespace cairn::lcp
