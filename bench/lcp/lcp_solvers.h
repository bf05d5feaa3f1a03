// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lcp/lcp_solver.h"

namespace cairn::cli {

/// A solver of problems in matrix form that the tool knows.
struct LcpSolverEntry {
  std::string name, description;
  /// Empty for a solver that is not in this build: the description says why.
  std::function<std::unique_ptr<LcpSolver>(const LcpOptions&)> make;
};

std::span<const LcpSolverEntry> LcpSolvers();

/// The solvers of Siconos Numerics for linear complementarity problems, called `siconos-...`. Their
/// `make` is empty where this tool was built without Siconos, and their description says so.
std::vector<LcpSolverEntry> SiconosSolvers();

}  // namespace cairn::cli
