// SPDX-License-Identifier: MIT
#include "frames/experiments.h"

#include <cairn/bullet/constraint_solver.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <span>

#include "run/scene_run.h"
#include "support/machine/run_context.h"
#include "support/machine/stopwatch.h"
#include "support/statistics.h"
#include "support/text_table.h"
#include "worlds/random_world.h"

namespace cairn::frames {
namespace {

using cli::Median;

class ThreadCpuClock final : public Clock {
 public:
  std::chrono::nanoseconds Now() const override {
    const double ms = cli::Now(cli::SolverClock::kThreadCpu);
    return std::chrono::nanoseconds(std::llround(1e6 * ms));
  }
};

/// Where the time of a budget ended, before its least sweeps were done.
bool CannotFit(const Report& report, int least_sweeps) {
  std::int64_t rows = 0;
  for (const IslandReport& island : report.islands) rows += island.rows;
  return report.stop == StopReason::kTimeSpent && report.replay.work < least_sweeps * rows;
}

int LeastSweeps(const Settings& settings) {
  const bool own = settings.tuning.min_sweeps != Tuning::kByBudget;
  return own ? settings.tuning.min_sweeps : Tuning::kLateSweeps;
}

/// What came of the substeps of a row of the table.
struct Lane {
  /// @param late  the time was up before the sweeps that are made in any case were done
  void Keep(const cli::ThreadTime& time, const Report& report, double budget_ms, bool late) {
    const double cpu_us = 1e3 * (time.cpu - budget_ms), wall_us = 1e3 * (time.wall - budget_ms);
    ++substeps;
    preempted += time.preempted ? 1 : 0;
    steps += report.steps_accepted + report.steps_restored;
    sweeps.push_back(report.sweeps);
    residuals.push_back(report.residual_max);
    if (late) {
      too_late.push_back(cpu_us);
      return;
    }
    cpu.push_back(cpu_us);
    wall.push_back(wall_us);
    if (!time.preempted) wall_calm.push_back(wall_us);
  }

  int substeps = 0, preempted = 0, steps = 0;
  std::vector<double> cpu, wall, wall_calm;  ///< over the budget, of those that fit [us]
  std::vector<double> too_late;              ///< CPU time, of the others
  std::vector<double> sweeps, residuals;
};

/// Cairn in a world, timed where the world waits for it.
class TimedSolver final : public btConstraintSolver {
 public:
  TimedSolver(const DeadlineOptions& options, double budget_ms)
      : budget_ms_(budget_ms),
        least_sweeps_(LeastSweeps(options.settings)),
        on_cpu_(options.clock == BudgetClock::kThreadCpu) {
    Settings& settings = solver_.settings() = options.settings;
    settings.budget = Budget::Time(std::chrono::nanoseconds(std::llround(budget_ms * 1e6)));
    if (on_cpu_) settings.tuning.clock = &cpu_clock_;
  }

  /// Where substeps go from now on; nullptr: nowhere.
  void KeepIn(Lane* lane) { lane_ = lane; }

  void prepareSolve(int bodies, int manifolds) override { solver_.prepareSolve(bodies, manifolds); }
  btScalar solveGroup(btCollisionObject** bodies, int num_bodies, btPersistentManifold** manifolds,
                      int num_manifolds, btTypedConstraint** joints, int num_joints,
                      const btContactSolverInfo& info, btIDebugDraw* debug_drawer,
                      btDispatcher* dispatcher) override {
    return solver_.solveGroup(bodies, num_bodies, manifolds, num_manifolds, joints, num_joints,
                              info, debug_drawer, dispatcher);
  }
  void allSolved(const btContactSolverInfo& info, btIDebugDraw* debug_drawer) override {
    const cli::ThreadStopwatch stopwatch;
    solver_.allSolved(info, debug_drawer);
    const cli::ThreadTime time = stopwatch.Read();
    const bool solved = !solver_.fell_back() && !solver_.report().islands.empty();
    if (lane_ == nullptr || !solved) return;
    // a thread that lost its core is late for another reason
    const bool fitted = !on_cpu_ && time.preempted;
    lane_->Keep(time, solver_.report(), budget_ms_,
                !fitted && CannotFit(solver_.report(), least_sweeps_));
  }
  void reset() override { solver_.reset(); }
  btConstraintSolverType getSolverType() const override { return solver_.getSolverType(); }

 private:
  bullet::ConstraintSolver solver_;
  ThreadCpuClock cpu_clock_;
  double budget_ms_;
  int least_sweeps_;
  bool on_cpu_;
  Lane* lane_ = nullptr;
};

void RunScene(const SceneChoice& choice, const DeadlineOptions& options, double budget_ms,
              Lane* lane) {
  TimedSolver solver(options, budget_ms);
  cli::SceneRun run(choice, &solver);
  run.Skip(choice.FirstFrame(options.warm_up));
  solver.KeepIn(lane);
  for (int i = 0; i < options.frames; ++i) run.Step();
}

void RunRandomWorld(std::uint64_t seed, const DeadlineOptions& options, double budget_ms,
                    Lane* lane) {
  TimedSolver solver(options, budget_ms);
  bench::RandomWorld world({.seed = seed}, &solver);
  const int frames = world.Frames(options.seconds);
  for (int frame = 0; frame < frames; ++frame) {
    if (frame == options.warm_up) solver.KeepIn(lane);
    world.Step();
  }
}

void AddRow(const std::string& name, double budget_ms, const Lane& lane, cli::TextTable* table) {
  const double all = lane.substeps;
  table->rows.push_back({name, fmt::format("{:g}", budget_ms), fmt::format("{}", lane.substeps),
                         Spread(lane.cpu), Spread(lane.wall_calm), Spread(lane.wall),
                         Percent(lane.preempted, all),
                         Percent(static_cast<double>(lane.too_late.size()), all),
                         lane.too_late.empty() ? "-" : fmt::format("{:.0f}", Median(lane.too_late)),
                         fmt::format("{:.0f}", Median(lane.sweeps)),
                         fmt::format("{:.2f}", lane.steps / std::max(1.0, all)),
                         fmt::format("{:.2g}", cli::Mean(lane.residuals))});
}

}  // namespace

void PrintDeadlines(const DeadlineOptions& options, const std::string& command) {
  fmt::print("{}", cli::Origin("Budget::Time in worlds that the adapter drives",
                               cli::DescribeContext(command)));
  fmt::print(
      "- times over the budget in us, p50 / p99 / p99.9 / max; negative: inside it; CPU is that of "
      "the calling thread;\n  calm: wall time of the substeps that were not preempted\n"
      "- too late: the time was up before the sweeps that are made in any case were done; those "
      "substeps are not in\n  the columns before, and their median is of CPU time\n"
      "- {} frames of a scene after {}; {} random worlds of {:g} s in one row, seeds from {} on; "
      "min_sweeps {}, threads {}\n"
      "- the clock of the budgets: {}\n\n",
      options.frames, options.warm_up, options.worlds, options.seconds, options.first_seed,
      LeastSweeps(options.settings), options.settings.threads,
      options.clock == BudgetClock::kThreadCpu ? "CPU time of the thread" : "wall");
  cli::TextTable table = cli::TableOf(
      {"world", "budget ms", "substeps", "CPU over us", "calm wall over us", "wall over us",
       "preempted %", "too late %", "by us", "sweeps p50", "steps a substep", "mean max m/s"});
  for (const SceneChoice& scene : options.scenes) {
    for (const double budget : options.budgets_ms) {
      Lane lane;
      RunScene(scene, options, budget, &lane);
      AddRow(NameOf(scene), budget, lane, &table);
    }
  }
  for (const double budget : options.budgets_ms) {
    Lane lane;
    for (int i = 0; i < options.worlds; ++i) {
      RunRandomWorld(options.first_seed + static_cast<std::uint64_t>(i), options, budget, &lane);
    }
    if (options.worlds > 0) AddRow("random worlds", budget, lane, &table);
  }
  fmt::print("{}\n", table.ToMarkdown());
}

}  // namespace cairn::frames
