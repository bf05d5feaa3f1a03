// SPDX-License-Identifier: MIT
#pragma once

#include "lcp/lcp_solver.h"
#include "lcp/siconos_form.h"
#include "lcp/siconos_method.h"

namespace cairn::cli {

/// A solver of Siconos Numerics, in the form of problem it likes best (siconos_form.h).
///
/// Its stop test is LcpResidual::relative, the same as ours. Building its form of the problem and
/// of the matrix is part of Solve() and of its time, as our preparations are of ours. Siconos shows
/// no iterates, so that the history has a start and an end only, and a time until an error is the
/// time of the whole solve: compare at the tolerance where its error is as small as asked. A budget
/// cannot be kept; --max-sweeps is the limit there is.
class SiconosLcpSolver : public LcpSolver {
 public:
  /// @param method  lives as long as the solver
  SiconosLcpSolver(const SiconosMethod& method, const LcpOptions& options)
      : method_(method), options_(options) {}

  LcpOutcome Solve(const BoxedLcp& problem, const Eigen::VectorXd& start,
                   const lcp::Observer& observer) override;

 private:
  /// Empty if a problem of that size is welcome.
  std::string WhyTooLarge(const SiconosForm& form) const;
  int MaxIterations(Eigen::Index rows) const;

  const SiconosMethod& method_;
  LcpOptions options_;
};

}  // namespace cairn::cli
