// SPDX-License-Identifier: MIT
#pragma once

#include "lcp/lcp_solver.h"

namespace cairn::cli {

/// Sweeps at most, unless the user says otherwise. Subspace steps and interior points have no limit
/// of their own: they end when they converge or when rounding stops them.
inline constexpr int kDefaultMaxSweeps = 50000;

/// Why a solve ended, fit for a narrow column.
std::string Name(lcp::StopReason reason);

/// What the options mean to a method.
lcp::Settings SettingsOf(lcp::Method method, const LcpOptions& options);

/// cairn::lcp::Solver with one of its methods.
class CairnLcpSolver : public LcpSolver {
 public:
  CairnLcpSolver(lcp::Method method, const LcpOptions& options);

  LcpOutcome Solve(const BoxedLcp& problem, const Eigen::VectorXd& start,
                   const lcp::Observer& observer) override;

 private:
  lcp::Settings settings_;
};

}  // namespace cairn::cli
