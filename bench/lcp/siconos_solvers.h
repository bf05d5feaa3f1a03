// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "lcp/lcp_solvers.h"

namespace cairn::cli {

/// The solvers of Siconos Numerics for linear complementarity problems, called `siconos-...`. Their
/// `make` is empty where this tool was built without Siconos, and their description says so.
std::vector<LcpSolverEntry> SiconosSolvers();

}  // namespace cairn::cli
