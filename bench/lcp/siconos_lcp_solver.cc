// SPDX-License-Identifier: MIT
#include "lcp/siconos_lcp_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "lcp/lcp_solvers.h"
#include "lcp/siconos_call.h"
#include "lcp/siconos_form.h"

namespace cairn::cli {
namespace {

/// Part of the tolerance that Siconos is given. The rest is for rounding: what counts in the end is
/// the residual of x in the problem itself, not of z in the form that Siconos saw.
constexpr double kShare = 0.99;

std::string Name(int info, SiconosStop stop) {
  if (info == 0) return "converged";
  if (info == 1 && stop != SiconosStop::kEnd) return "sweep limit";
  return fmt::format("ended with info {}", info);
}

}  // namespace

LcpOutcome SiconosLcpSolver::Solve(const BoxedLcp& problem, const Eigen::VectorXd& start,
                                   const lcp::Observer&) {
  LcpOutcome outcome;
  outcome.x = start.cwiseMax(problem.lo).cwiseMin(problem.hi);
  SiconosForm form;
  outcome.failure = form.Choose(problem);
  if (outcome.failure.empty()) outcome.failure = WhyTooLarge(form);
  if (outcome.failure.empty()) outcome.failure = form.Build(problem, outcome.x);
  if (!outcome.failure.empty()) {
    outcome.stop = "refused";
    return outcome;
  }
  SiconosAnswer answer = CallSiconos({.method = method_,
                                      .lcp = form.lcp(),
                                      .tolerance = kShare * form.Tolerance(options_.tolerance),
                                      .max_iterations = MaxIterations(form.rows()),
                                      .threads = options_.threads});
  outcome.sweeps = answer.iterations;
  outcome.stop = Name(answer.info, method_.stop);
  if (!answer.fatal.empty()) outcome.failure = "Siconos broke down: " + answer.fatal;
  // What Siconos leaves behind when it fails need not be a number.
  if (answer.z.allFinite()) outcome.x = form.Restore(answer.z);
  return outcome;
}

std::string SiconosLcpSolver::WhyTooLarge(const SiconosForm& form) const {
  const Eigen::Index rows = form.rows();
  const double bytes = form.Memory() + 8.0 * static_cast<double>(rows) * static_cast<double>(rows) *
                                           static_cast<double>(method_.matrices);
  if (bytes <= kSiconosMemory) return "";
  return fmt::format("too large: {} needs {:.1f} GiB of dense matrices for {} rows, {:.1f} allowed",
                     method_.name, bytes / (1 << 30), rows, kSiconosMemory / (1 << 30));
}

int SiconosLcpSolver::MaxIterations(Eigen::Index rows) const {
  if (options_.max_sweeps) return *options_.max_sweeps;
  if (method_.stop != SiconosStop::kEnd) return method_.max_iterations;
  constexpr Eigen::Index kMost = std::numeric_limits<int>::max();
  return static_cast<int>(std::min(kMost, method_.max_iterations * rows));
}

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
