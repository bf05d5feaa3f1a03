// SPDX-License-Identifier: MIT
#include "measure/converged.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "cairn/solver.h"
#include "measure/reference.h"

namespace cairn::bench {
namespace {

/// One after the other: large terms bring down what is far off, small ones the rest.
constexpr std::array kProximal = {3e-3, 1e-3, 1e-4, 1e-5};
constexpr int kMostRounds = 20;
constexpr double kFewestSweeps = 200, kMostSweeps = 5000;  // with each term in a round
constexpr int kStepsInThem = 10;
/// A round that leaves more than this share of the residual ends it.
constexpr double kProgress = 0.9;

Settings SettingsWith(double proximal, int sweeps) {
  Settings settings = ReferenceSettings();
  settings.path = Path::kReference;        // in double precision
  settings.tolerance = kConvergedTo / 10;  // beneath what Measure() has to find
  settings.max_sweeps = sweeps;
  settings.k_gs = sweeps / kStepsInThem;
  settings.step_policy = StepPolicy::kAlways;
  settings.tuning.proximal = proximal;
  // Measured on one frame of the bridge, where neither comes below 1.3e-4 m/s: 1e-8 ends 0.05 m/s
  // away from 200,000 plain sweeps, 1e-4 and 1e-5 end 2e-4 m/s away.
  settings.proximal_joints = 1e-4;
  return settings;
}

Converged SolveFrom(std::vector<double> impulses, const ContactFrame& frame, double work) {
  Converged result;
  result.velocities.resize(frame.bodies.size());
  result.residual_max = kInfinity;
  // the work is for two rounds at least
  const double affordable = work / static_cast<double>(frame.rows.size());
  const int sweeps =
      static_cast<int>(std::clamp(affordable / (2 * kProximal.size()), kFewestSweeps, kMostSweeps));
  for (int round = 0; round < kMostRounds && !result.reached; ++round) {
    const double before = result.residual_max;
    for (const double proximal : kProximal) {
      if (result.reached || result.sweeps >= affordable) break;
      Solver solver(SettingsWith(proximal, sweeps));
      const Report report = solver.Solve(frame.problem(), impulses, result.velocities);
      if (!report.ok()) throw std::runtime_error(std::string(Describe(report.status)));
      const Report measured = Measure(frame.problem(), impulses);
      result.residual_max = measured.residual_max;
      result.residual_energy = measured.residual_energy;
      result.sweeps += report.sweeps;
      result.factorisations += report.factorisations;
      result.reached = measured.residual_max <= kConvergedTo;
    }
    if (result.residual_max > kProgress * before) break;
  }
  return result;
}

}  // namespace

Converged Converge(const ContactFrame& frame, const VelocityNorm& norm, double work) {
  Converged result = SolveFrom(frame.impulses, frame, work);
  const Converged other = SolveFrom(std::vector<double>(frame.rows.size()), frame, work);
  result.spread = norm.Between(result.velocities, other.velocities);
  return result;
}

}  // namespace cairn::bench
