// SPDX-License-Identifier: MIT
#include "lcp/siconos_solvers.h"

#include "lcp/siconos_lcp_solver.h"
#include "lcp/siconos_method.h"

namespace cairn::cli {

std::vector<LcpSolverEntry> SiconosSolvers() {
  std::vector<LcpSolverEntry> entries;
  for (const SiconosMethod& method : SiconosMethods()) {
    entries.push_back({method.name, method.description, [&method](const LcpOptions& options) {
                         return std::make_unique<SiconosLcpSolver>(method, options);
                       }});
  }
  return entries;
}

}  // namespace cairn::cli
