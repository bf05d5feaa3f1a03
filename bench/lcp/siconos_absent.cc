// SPDX-License-Identifier: MIT
// Stands in for siconos_solvers.cc where Siconos is not installed.
#include "lcp/siconos_method.h"
#include "lcp/siconos_solvers.h"

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
