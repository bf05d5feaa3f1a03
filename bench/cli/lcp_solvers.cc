// SPDX-License-Identifier: MIT
#include "cli/lcp_solvers.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/cairn_lcp_solver.h"
#include "cli/failure.h"
#include "cli/names.h"
#include "cli/siconos_solvers.h"

namespace cairn::cli {
namespace {

template <Method method>
std::unique_ptr<LcpSolver> MakeCairn(const LcpOptions& options) {
  return std::make_unique<CairnLcpSolver>(method, options);
}

std::vector<LcpSolverEntry> Join(std::vector<LcpSolverEntry> first,
                                 const std::vector<LcpSolverEntry>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

}  // namespace

std::span<const LcpSolverEntry> LcpSolvers() {
  using enum Method;
  static const std::vector<LcpSolverEntry> solvers = Join(
      {
          {"pgs", "projected Gauss-Seidel", &MakeCairn<kPgs>},
          {"psor", "the same, over-relaxed (--omega)", &MakeCairn<kPsor>},
          {"pgs-sm", "Cairn: sweeps and safeguarded subspace steps", &MakeCairn<kPgsSm>},
          {"pgs-sm-literal", "sweeps and subspace steps exactly as the paper states them",
           &MakeCairn<kPgsSmLiteral>},
          {"ipm", "Mehrotra's predictor-corrector interior point method",
           &MakeCairn<kInteriorPoint>},
      },
      SiconosSolvers());
  return solvers;
}

std::vector<const LcpSolverEntry*> ParseLcpSolvers(std::string_view list) {
  std::vector<std::string> names;
  for (const LcpSolverEntry& entry : LcpSolvers()) names.push_back(entry.name);
  std::vector<const LcpSolverEntry*> chosen;
  for (const std::string& word : Split(list, ',')) {
    const LcpSolverEntry& entry =
        LcpSolvers()[FindName("solver", word, names, "'cairn list solvers' shows all")];
    if (std::find(chosen.begin(), chosen.end(), &entry) != chosen.end()) {
      throw Failure(kUsage, fmt::format("--solver names {} twice", entry.name));
    }
    if (!entry.make) {
      throw Failure(kUsage, fmt::format("--solver {}: {}", entry.name, entry.description));
    }
    chosen.push_back(&entry);
  }
  if (chosen.empty()) {
    throw Failure(kUsage, "--solver names no solver; 'cairn list solvers' shows all");
  }
  return chosen;
}

}  // namespace cairn::cli
