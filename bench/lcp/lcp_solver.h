// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "cairn/lcp/solver.h"
#include "cairn/mixed_lcp.h"

namespace cairn::cli {

/// What solvers of problems in matrix form are told. A solver leaves out what it does not have.
struct LcpOptions {
  double tolerance = 1e-9;        ///< LcpResidual::relative at which to stop, > 0.
  std::optional<int> max_sweeps;  ///< None: the solver's own limit.
  std::optional<std::chrono::nanoseconds> budget;
  int threads = 1;
  lcp::SweepOrder order = lcp::SweepOrder::kAutomatic;
  int k_gs = lcp::Settings{}.k_gs, k_sm = lcp::Settings{}.k_sm;
  double active_tolerance = lcp::Settings{}.active_tolerance;
  double omega = 1.5;   ///< Over-relaxation of solvers that have it, in (0, 2).
  bool phases = false;  ///< Say where the time goes, if the solver can.
};

/// What a solver of a problem in matrix form did. Counts are 0 where they have no meaning.
struct LcpOutcome {
  Eigen::VectorXd x;
  int sweeps = 0, factorisations = 0;
  int analyses = 0;                  ///< Symbolic factorisations.
  std::int64_t factor_nonzeros = 0;  ///< Entries of the largest factor.
  int steps_accepted = 0, steps_restored = 0;
  lcp::Phases phases;   ///< All 0 unless LcpOptions::phases.
  std::string stop;     ///< Why it ended, a few words: "converged".
  std::string failure;  ///< Why it could not start, or broke down; empty if it did not.
};

/// A solver of problems in matrix form, of any make. A new one is one class and one line in
/// lcp_solvers.cc.
class LcpSolver {
 public:
  virtual ~LcpSolver() = default;

  /// Solves from `start`, which need not be inside the bounds. Keeps nothing for the next problem.
  /// @param observer  is shown every iterate, if there is one; where it answers false, the solver
  ///                  ends. Its time is subtracted by the caller.
  virtual LcpOutcome Solve(const BoxedLcp& problem, const Eigen::VectorXd& start,
                           const lcp::Observer& observer) = 0;
};

}  // namespace cairn::cli
