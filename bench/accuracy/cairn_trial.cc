// SPDX-License-Identifier: MIT
#include "accuracy/cairn_trial.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "cli/statistics.h"

namespace cairn::accuracy {
namespace {

/// Tries of a round until one is not interrupted.
constexpr int kTries = 8;

Budget Milliseconds(double budget) {
  return Budget::Time(std::chrono::nanoseconds(std::llround(budget * 1e6)));
}

Settings SettingsOf(Kind kind) {
  Settings settings = frames::Sweeps(std::numeric_limits<int>::max(), 1);
  if (kind == Kind::kSteps) settings.method = Method::kPgsSm;
  return settings;
}

}  // namespace

CairnTrial::CairnTrial(Kind kind) : solver_(SettingsOf(kind)) {}

void CairnTrial::Round(const bench::ContactFrame& before, const bench::ContactFrame& frame,
                       double budget) {
  solver_.settings().budget = Milliseconds(budget);
  for (int i = 0; i < kTries; ++i) {
    if (!before.rows.empty()) solver_.Solve(before);
    time_ = solver_.Solve(frame);
    if (!time_.preempted) return;
  }
}

void CairnTrial::Keep(const VelocityDistance& error) {
  const Report& report = solver_.report();
  rms_.push_back(error.rms);
  max_.push_back(error.max);
  residual_.push_back(report.residual_max);
  cpu_.push_back(time_.cpu_us * 1e-3);
  wall_.push_back(time_.wall_us * 1e-3);
  sweeps_.push_back(report.sweeps);
  sums_.accepted += report.steps_accepted;
  sums_.restored += report.steps_restored;
  sums_.factorisations += report.factorisations;
  sums_.preempted += time_.preempted ? 1 : 0;
  ++sums_.rounds;
}

CairnResult CairnTrial::Take() {
  CairnResult result = std::exchange(sums_, {});
  const double rounds = std::max(1, result.rounds);
  result.accepted /= rounds;
  result.restored /= rounds;
  result.factorisations /= rounds;
  result.least_rms = cli::Quantile(rms_, 0);
  result.most_rms = cli::Largest(rms_);
  result.error = {.rms = cli::Median(rms_), .max = cli::Median(max_)};
  result.residual_max = cli::Median(residual_);
  result.cpu = cli::Median(cpu_);
  result.wall = cli::Median(wall_);
  result.sweeps = cli::Median(sweeps_);
  for (auto* values : {&rms_, &max_, &residual_, &cpu_, &wall_, &sweeps_}) values->clear();
  return result;
}

double SolveFloor(const bench::ContactFrame& before, const bench::ContactFrame& frame, int rounds) {
  Settings settings = SettingsOf(Kind::kSweeps);
  settings.budget = Milliseconds(0);
  settings.min_sweeps = 0;
  frames::FrameSolver solver(settings);
  std::vector<double> times;
  for (int i = -1; i < rounds; ++i) {
    if (!before.rows.empty()) solver.Solve(before);
    const frames::SolveTime time = solver.Solve(frame);
    if (i >= 0) times.push_back(time.cpu_us * 1e-3);
  }
  return cli::Median(times);
}

}  // namespace cairn::accuracy
