// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "lcp/lcp_solver.h"

namespace cairn::cli {

/// A solver of problems in matrix form that the tool knows.
struct LcpSolverEntry {
  std::string name, description;
  /// Empty for a solver that is not in this build: the description says why.
  std::function<std::unique_ptr<LcpSolver>(const LcpOptions&)> make;
};

std::span<const LcpSolverEntry> LcpSolvers();

}  // namespace cairn::cli
