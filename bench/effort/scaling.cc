// SPDX-License-Identifier: MIT
#include "effort/scaling.h"

#include <algorithm>
#include <memory>
#include <thread>

#include "cairn/solver.h"
#include "simd/target.h"
#include "support/machine/setup.h"
#include "support/machine/stopwatch.h"
#include "support/statistics.h"

namespace cairn::cli {
namespace {

constexpr int kSweeps = 10;
/// All in turn so often, unless that takes too long.
constexpr int kMostRounds = 15, kLeastRounds = 3;
constexpr double kLongest = 2000;  // [ms]

Settings TenSweeps(int threads) {
  Settings settings;
  settings.method = Method::kPgs;
  settings.max_sweeps = kSweeps;
  settings.tolerance = 0;
  settings.threads = threads;
  return settings;
}

/// A solver with the memory that it writes to.
class TimedSolver {
 public:
  TimedSolver(const ContactProblem& problem, simd::Target target, int threads)
      : problem_(problem),
        rows_(problem.rows.size()),
        points_(problem.points.size()),
        twists_(problem.twists.size()),
        velocities_(problem.bodies.size()) {
    const ForcedTarget forced(target);
    solver_ = std::make_unique<Solver>(TenSweeps(threads));
    Solve();
  }

  void Time() {
    const Stopwatch stopwatch(SolverClock::kWall);
    Solve();
    times_.push_back(stopwatch.Read());
  }
  double Median() const { return cli::Median(times_); }

 private:
  void Solve() {
    std::fill(rows_.begin(), rows_.end(), 0.0);
    std::fill(points_.begin(), points_.end(), ContactImpulse{});
    std::fill(twists_.begin(), twists_.end(), TwistImpulse{});
    solver_->Solve(problem_, {rows_, points_, twists_}, velocities_, &report_);
  }

  const ContactProblem& problem_;
  std::vector<double> rows_;
  std::vector<ContactImpulse> points_;
  std::vector<TwistImpulse> twists_;
  std::vector<Velocity> velocities_;
  std::unique_ptr<Solver> solver_;
  Report report_;
  std::vector<double> times_;
};

std::vector<int> ThreadCounts() {
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  std::vector<int> counts;
  for (int count = 1; count < cores; count *= 2) counts.push_back(count);
  counts.push_back(cores);
  return counts;
}

}  // namespace

Scaling MeasureScaling(const ContactProblem& problem) {
  Scaling result;
  result.rows = static_cast<int>(AllRows(problem));
  if (problem.bodies.empty() || result.rows == 0) return result;
  std::vector<std::unique_ptr<TimedSolver>> threads, targets;
  const std::vector<int> counts = ThreadCounts();
  for (int count : counts) {
    threads.push_back(std::make_unique<TimedSolver>(problem, simd::BestTarget(), count));
  }
  for (simd::Target target : simd::SupportedTargets()) {
    targets.push_back(std::make_unique<TimedSolver>(problem, target, 1));
  }

  const Stopwatch stopwatch(SolverClock::kWall);
  for (int round = 0; round < kMostRounds; ++round) {
    if (round >= kLeastRounds && stopwatch.Read() > kLongest) break;
    for (const auto& solver : threads) solver->Time();
    for (const auto& solver : targets) solver->Time();
  }
  for (size_t i = 0; i < counts.size(); ++i) {
    result.threads.push_back({std::to_string(counts[i]), threads[i]->Median()});
  }
  for (size_t i = 0; i < targets.size(); ++i) {
    const simd::Target target = simd::SupportedTargets()[i];
    result.targets.push_back({std::string(simd::TargetName(target)), targets[i]->Median()});
  }
  return result;
}

}  // namespace cairn::cli
