// SPDX-License-Identifier: MIT
#include "solve/error_meter.h"

#include <algorithm>
#include <cmath>

#include "cairn/lcp/solver.h"
#include "support/statistics.h"

namespace cairn::cli {
namespace {

/// What the methods below are asked for, as LcpResidual::relative; rounding stops them earlier.
constexpr double kBestTolerance = 1e-12;
/// Sweeps that try to improve on a point: rounding inside a factorisation is theirs to remove.
constexpr int kRefiningSweeps = 200;
/// Sweeps where everything else failed.
constexpr int kManySweeps = 100000;

double OrOne(double scale) { return scale > 0 ? scale : 1; }

double EnergyNorm(const BoxedLcp& lcp, const Eigen::VectorXd& x) {
  // Rounding may leave a tiny negative number where M is singular.
  return std::sqrt(std::max(0.0, x.dot(lcp.M * x)));
}

/// The best point found, and its LcpResidual::relative.
struct Best {
  Eigen::VectorXd x;
  double residual = kNotMeasured;
};

Best FindBest(const problems::Problem& problem) {
  Best best;
  best.x = Eigen::VectorXd::Zero(problem.lcp.size());
  best.residual = Measure(problem.lcp, best.x).relative;
  struct Stage {
    double above;  ///< Tried if the best residual is larger.
    lcp::Settings settings;
  };
  const Stage stages[] = {
      {0, {.method = lcp::Method::kPgsSm, .tolerance = kBestTolerance}},
      {kBestTolerance, {.method = lcp::Method::kInteriorPoint, .tolerance = kBestTolerance}},
      {kBestTolerance,
       {.method = lcp::Method::kPgs, .max_sweeps = kRefiningSweeps, .tolerance = kBestTolerance}},
      {1e-8,
       {.method = lcp::Method::kPgs, .max_sweeps = kManySweeps, .tolerance = kBestTolerance}}};
  for (const Stage& stage : stages) {
    if (best.residual <= stage.above) break;
    Eigen::VectorXd x = best.x;
    if (!lcp::Solver(stage.settings).Solve(problem.lcp, &x).ok()) continue;
    const double residual = Measure(problem.lcp, x).relative;
    if (residual < best.residual) best = {x, residual};
  }
  return best;
}

}  // namespace

ErrorMeter::ErrorMeter(const problems::Problem& problem) {
  if (problem.solution.size() != 0) {
    truth_ = Truth::kSolution;
    target_ = problem.solution;
  } else if (problem.slack.size() != 0) {
    truth_ = Truth::kSlack;
    target_ = problem.slack;
  } else {
    const Best best = FindBest(problem);
    truth_ = Truth::kBestFound;
    target_ = best.x;
    best_residual_ = best.residual;
  }
  scale_ = OrOne(truth_ == Truth::kSlack ? problem.lcp.q.norm() : target_.norm());
  energy_scale_ = truth_ == Truth::kSlack ? 1 : OrOne(EnergyNorm(problem.lcp, target_));
}

const char* ErrorMeter::name() const {
  switch (truth_) {
    case Truth::kNone:
      return "-";
    case Truth::kSolution:
      return "x";
    case Truth::kSlack:
      return "w";
    case Truth::kBestFound:
      return "best";
    case Truth::kConverged:
      return "reference";
  }
  return "-";
}

double ErrorMeter::Error(const BoxedLcp& lcp, const Eigen::VectorXd& x) const {
  if (truth_ == Truth::kNone) return kNotMeasured;
  if (truth_ == Truth::kSlack) return (lcp.M * x + lcp.q - target_).norm() / scale_;
  return (x - target_).norm() / scale_;
}

double ErrorMeter::EnergyError(const BoxedLcp& lcp, const Eigen::VectorXd& x) const {
  if (truth_ == Truth::kNone || truth_ == Truth::kSlack) return kNotMeasured;
  return EnergyNorm(lcp, x - target_) / energy_scale_;
}

}  // namespace cairn::cli
