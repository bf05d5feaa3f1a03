// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lcp/lcp_solvers.h"
#include "rows/row_solvers.h"

namespace cairn::cli {

/// Solvers of `cairn solve`, each with the problems that it takes: those in matrix form, recorded
/// frames, or both.
struct SolverChoices {
  std::vector<std::string> names;  ///< As they were typed, each once.
  std::vector<const LcpSolverEntry*> of_matrices;
  std::vector<const RowSolverEntry*> of_frames;
};

/// Which problems there are.
struct ProblemKinds {
  bool matrices = false, frames = false;
};

/// Entries of a list of names with commas; an empty list is the usual solvers of the problems that
/// there are.
/// @throws Failure (kUsage): an unknown name, one that takes none of the problems, or a kind of
/// problem that none of them takes
SolverChoices ChooseSolvers(std::string_view list, const ProblemKinds& kinds);

}  // namespace cairn::cli
