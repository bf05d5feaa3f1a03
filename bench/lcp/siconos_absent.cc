// SPDX-License-Identifier: MIT
// Stands in for siconos_lcp_solver.cc where Siconos is not installed.
#include "lcp/lcp_solvers.h"
#include "lcp/siconos_method.h"

namespace cairn::cli {

std::vector<LcpSolverEntry> SiconosSolvers() {
  std::vector<LcpSolverEntry> entries;
  for (const SiconosMethod& method : SiconosMethods()) {
    entries.push_back({method.name,
                       "not in this build: install libsiconos-numerics-dev and build again",
                       nullptr});
  }
  return entries;
}

}  // namespace cairn::cli
