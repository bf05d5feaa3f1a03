// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <string>

#include "rows/row_solver.h"

namespace cairn::cli {

/// A solver of recorded frames that the tool knows.
struct RowSolverEntry {
  std::string name, description;
  /// In the options, LcpOptions::tolerance is a natural residual [m/s] or [rad/s], 0: none.
  std::unique_ptr<RowSolver> (*make)(const LcpOptions&);
};

std::span<const RowSolverEntry> RowSolvers();

}  // namespace cairn::cli
