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

/// A substep that fitted.
struct Substep {
  std::string world;
  int frame = 0;
  double cpu_us = 0;  ///< over the budget
  bullet::SubstepTimes times;
  int islands = 0, bodies = 0, rows = 0, sweeps = 0, factorisations = 0, kept = 0, undone = 0;
};

Substep Describe(const bullet::ConstraintSolver& solver, double cpu_us) {
  const Report& report = solver.report();
  Substep substep = {.world = {},
                     .cpu_us = cpu_us,
                     .times = solver.times(),
                     .islands = static_cast<int>(report.islands.size()),
                     .sweeps = report.sweeps,
                     .kept = report.steps_accepted,
                     .undone = report.steps_restored};
  for (const IslandReport& island : report.islands) {
    substep.bodies += island.bodies;
    substep.rows += island.rows;
    substep.factorisations += island.factorisations;
  }
  return substep;
}

/// What came of the substeps of a row of the table.
struct Tally {
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
  /// Of the substep kept last, if it is one of the @p most latest.
  void KeepWorst(const bullet::ConstraintSolver& solver, int most) {
    if (most == 0) return;
    const auto earlier = [](const Substep& a, const Substep& b) { return a.cpu_us > b.cpu_us; };
    const double cpu_us = cpu.back();
    const bool full = static_cast<int>(worst.size()) == most;
    if (full && worst.back().cpu_us >= cpu_us) return;
    if (full) worst.pop_back();
    Substep substep = Describe(solver, cpu_us);
    substep.world = world;
    substep.frame = frame;
    worst.insert(std::upper_bound(worst.begin(), worst.end(), substep, earlier), substep);
  }

  int substeps = 0, preempted = 0, steps = 0;
  std::vector<double> cpu, wall, wall_calm;  ///< over the budget, of those that fit [us]
  std::vector<double> too_late;              ///< CPU time, of the others
  std::vector<double> sweeps, residuals;
  std::vector<Substep> worst;  ///< the latest first
  std::string world;           ///< that runs
  int frame = 0;               ///< of it
};

/// Cairn in a world, timed where the world waits for it.
class TimedSolver final : public btConstraintSolver {
 public:
  TimedSolver(const DeadlineOptions& options, double budget_ms)
      : budget_ms_(budget_ms),
        least_sweeps_(LeastSweeps(options.settings)),
        worst_(options.worst),
        on_cpu_(options.clock == BudgetClock::kThreadCpu) {
    Settings& settings = solver_.settings() = options.settings;
    settings.budget = Budget::Time(std::chrono::nanoseconds(std::llround(budget_ms * 1e6)));
    if (on_cpu_) settings.tuning.clock = &cpu_clock_;
  }

  /// Where substeps go from now on; nullptr: nowhere.
  void KeepIn(Tally* tally) { tally_ = tally; }

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
    if (tally_ == nullptr || !solved) return;
    // a thread that lost its core is late for another reason
    const bool fitted = !on_cpu_ && time.preempted;
    const bool late = !fitted && CannotFit(solver_.report(), least_sweeps_);
    tally_->Keep(time, solver_.report(), budget_ms_, late);
    if (!late) tally_->KeepWorst(solver_, worst_);
  }
  void reset() override { solver_.reset(); }
  btConstraintSolverType getSolverType() const override { return solver_.getSolverType(); }

 private:
  bullet::ConstraintSolver solver_;
  ThreadCpuClock cpu_clock_;
  double budget_ms_;
  int least_sweeps_, worst_;
  bool on_cpu_;
  Tally* tally_ = nullptr;
};

void RunScene(const SceneChoice& choice, const DeadlineOptions& options, double budget_ms,
              Tally* tally) {
  TimedSolver solver(options, budget_ms);
  cli::SceneRun run(choice, &solver);
  run.Skip(choice.FirstFrame(options.warm_up));
  solver.KeepIn(tally);
  tally->world = NameOf(choice);
  for (tally->frame = 0; tally->frame < options.frames; ++tally->frame) run.Step();
}

void RunRandomWorld(std::uint64_t seed, const DeadlineOptions& options, double budget_ms,
                    Tally* tally) {
  TimedSolver solver(options, budget_ms);
  bench::RandomWorld world({.seed = seed}, &solver);
  const int frames = world.Frames(options.seconds);
  tally->world = fmt::format("seed {}", seed);
  for (int frame = 0; frame < frames; ++frame) {
    if (frame == options.warm_up) solver.KeepIn(tally);
    tally->frame = frame;
    world.Step();
  }
}

/// What the machine does to a thread that only waits for its time to be up: no solver keeps a
/// budget better than that.
Tally WaitForTheClock(const DeadlineOptions& options, double budget_ms) {
  const auto times = static_cast<int>(1e3 * options.seconds / std::max(budget_ms, 0.05));
  const cli::SolverClock clock = options.clock == BudgetClock::kThreadCpu
                                     ? cli::SolverClock::kThreadCpu
                                     : cli::SolverClock::kWall;
  Tally tally;
  for (int i = 0; i < times; ++i) {
    const cli::ThreadStopwatch stopwatch;
    const double end = cli::Now(clock) + budget_ms;
    while (cli::Now(clock) < end) {
    }
    tally.Keep(stopwatch.Read(), Report(), budget_ms, false);
  }
  return tally;
}

/// "p50 / p99 / p99.9 / max", or "-" of nothing.
std::string Spread(std::span<const double> values) {
  if (values.empty()) return "-";
  return fmt::format("{:.0f} / {:.0f} / {:.0f} / {:.0f}", Median(values),
                     cli::Quantile(values, 0.99), cli::Quantile(values, 0.999),
                     cli::Largest(values));
}

/// With one digit, or "-" of nothing.
std::string Percent(double part, double all) {
  return all > 0 ? fmt::format("{:.1f}", 100 * part / all) : "-";
}

void AddRow(const std::string& name, double budget_ms, const Tally& tally, cli::TextTable* table) {
  const double all = tally.substeps;
  table->rows.push_back(
      {name, fmt::format("{:g}", budget_ms), fmt::format("{}", tally.substeps), Spread(tally.cpu),
       Spread(tally.wall_calm), Spread(tally.wall), Percent(tally.preempted, all),
       Percent(static_cast<double>(tally.too_late.size()), all),
       tally.too_late.empty() ? "-" : fmt::format("{:.0f}", Median(tally.too_late)),
       fmt::format("{:.0f}", Median(tally.sweeps)),
       fmt::format("{:.2f}", tally.steps / std::max(1.0, all)),
       fmt::format("{:.2g}", cli::Mean(tally.residuals))});
}

void AddWorst(double budget_ms, const Tally& tally, cli::TextTable* table) {
  const auto us = [](std::chrono::nanoseconds time) {
    return fmt::format("{:.0f}", 1e-3 * static_cast<double>(time.count()));
  };
  for (const Substep& substep : tally.worst) {
    table->rows.push_back(
        {substep.world, fmt::format("{:g}", budget_ms), fmt::format("{}", substep.frame),
         fmt::format("{:.0f}", substep.cpu_us), us(substep.times.build), us(substep.times.solve),
         us(substep.times.write), fmt::format("{}", substep.islands),
         fmt::format("{}", substep.bodies), fmt::format("{}", substep.rows),
         fmt::format("{}", substep.sweeps), fmt::format("{}", substep.factorisations),
         fmt::format("{} / {}", substep.kept, substep.undone)});
  }
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
      "- the clock of the budgets: {}\n"
      "- the clock alone: a loop for {:g} s that only waits for the time to be up, again and "
      "again;\n"
      "  what it is late by comes from the machine\n\n",
      options.frames, options.warm_up, options.worlds, options.seconds, options.first_seed,
      LeastSweeps(options.settings), options.settings.threads,
      options.clock == BudgetClock::kThreadCpu ? "CPU time of the thread" : "wall",
      options.seconds);
  cli::TextTable table = cli::TableOf(
      {"world", "budget ms", "substeps", "CPU over us", "calm wall over us", "wall over us",
       "preempted %", "too late %", "by us", "sweeps p50", "steps a substep", "mean max m/s"});
  cli::TextTable worst = cli::TableOf({"world", "budget ms", "frame", "CPU over us", "build us",
                                       "solve us", "write us", "islands", "bodies", "rows",
                                       "sweeps", "factorisations", "steps kept / undone"});
  for (const double budget : options.budgets_ms) {
    AddRow("the clock alone", budget, WaitForTheClock(options, budget), &table);
  }
  for (const SceneChoice& scene : options.scenes) {
    for (const double budget : options.budgets_ms) {
      Tally tally;
      RunScene(scene, options, budget, &tally);
      AddRow(NameOf(scene), budget, tally, &table);
      AddWorst(budget, tally, &worst);
    }
  }
  for (const double budget : options.budgets_ms) {
    Tally tally;
    for (int i = 0; i < options.worlds; ++i) {
      RunRandomWorld(options.first_seed + static_cast<std::uint64_t>(i), options, budget, &tally);
    }
    if (options.worlds > 0) AddRow("random worlds", budget, tally, &table);
    AddWorst(budget, tally, &worst);
  }
  fmt::print("{}\n", table.ToMarkdown());
  if (!worst.rows.empty()) fmt::print("The latest substeps:\n\n{}\n", worst.ToMarkdown());
}

}  // namespace cairn::frames
