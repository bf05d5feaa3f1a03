// SPDX-License-Identifier: MIT
#include "lcp/lcp_solvers.h"

#include "lcp/cairn_lcp_solver.h"

namespace cairn::cli {
namespace {

template <lcp::Method method>
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
  using enum lcp::Method;
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

}  // namespace cairn::cli
