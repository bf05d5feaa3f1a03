// SPDX-License-Identifier: MIT
#include "frames/experiments.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <span>

#include "frames/frame_solver.h"
#include "run/scene_run.h"
#include "support/machine/run_context.h"
#include "support/statistics.h"
#include "support/text_table.h"

namespace cairn::frames {
namespace {

using bench::ContactFrame;
using cli::Median;

/// One solve in so many is measured again in double precision, outside the clocks.
constexpr int kCheckEvery = 97;

/// The solves under one budget.
struct Lane {
  explicit Lane(const Settings& settings)
      : solver(settings), budget_us(static_cast<double>(settings.budget.time().count()) * 1e-3) {}

  void Keep(const cli::ThreadTime& time) {
    const Report& report = solver.report();
    wall.push_back(1e3 * time.wall - budget_us);
    cpu.push_back(1e3 * time.cpu - budget_us);
    if (!time.preempted) wall_calm.push_back(1e3 * time.wall - budget_us);
    sweeps.push_back(report.sweeps);
    energy.push_back(report.residual_energy);
    residual_max.push_back(report.residual_max);
    if (report.stop != StopReason::kTimeSpent) ++not_by_clock;
  }
  void Check(const ContactFrame& frame) {
    const double measured = Measure(frame.problem(), solver.impulses()).residual_energy;
    const double difference = std::abs(solver.report().residual_energy - measured);
    if (measured > 0) largest_error = std::max(largest_error, difference / measured);
  }

  FrameSolver solver;
  double budget_us;
  std::vector<double> wall, cpu, wall_calm;  ///< over the budget [us]
  std::vector<double> sweeps, energy, residual_max;
  int not_by_clock = 0;
  double largest_error = 0;  ///< of the energy that is reported, relative
};

Settings Under(double budget_ms, const BudgetOptions& options) {
  Settings settings = Sweeps(1000000, options.threads);
  settings.method = options.method;
  settings.tuning.min_sweeps = options.min_sweeps;
  settings.budget = Budget::Time(std::chrono::nanoseconds(std::llround(budget_ms * 1e6)));
  return settings;
}

std::vector<ContactFrame> Record(const SceneChoice& scene, const BudgetOptions& options) {
  cli::StateRun run(scene);
  const int first = scene.FirstFrame(options.first);
  run.Skip(first);
  std::vector<ContactFrame> frames;
  std::int64_t rows = 0;
  for (int i = first; i <= first + options.last - options.first && rows < options.most_rows; ++i) {
    frames.push_back(run.Record());
    rows += static_cast<std::int64_t>(frames.back().rows.size());
  }
  return frames;
}

/// Forth and back through the frames: each solve follows one of a neighbouring frame.
size_t FrameOf(int solve, size_t frames) {
  if (frames == 1) return 0;
  const size_t turn = 2 * (frames - 1), at = static_cast<size_t>(solve) % turn;
  return at < frames ? at : turn - at;
}

/// The last lane has no budget at all: what reading rows and writing results takes.
std::vector<Lane> SolveAll(const std::vector<ContactFrame>& frames, const BudgetOptions& options) {
  std::vector<Lane> lanes;
  for (const double budget : options.budgets_ms) lanes.emplace_back(Under(budget, options));
  Settings floor = Under(0, options);
  floor.tuning.min_sweeps = 0;
  lanes.emplace_back(floor);

  // one round to allocate and to learn prices
  const int warm_up = static_cast<int>(2 * frames.size());
  for (int i = -warm_up; i < options.solves; ++i) {
    const ContactFrame& frame = frames[FrameOf(i + warm_up, frames.size())];
    for (size_t k = 0; k < lanes.size(); ++k) {
      // the order changes, so that no lane always finds the caches as the same other one left them
      Lane& lane = lanes[(k + static_cast<size_t>(i + warm_up)) % lanes.size()];
      const cli::ThreadTime time = lane.solver.Solve(frame);
      if (i < 0) continue;
      lane.Keep(time);
      if (i % kCheckEvery == 0) lane.Check(frame);
    }
  }
  return lanes;
}

double Over(const std::vector<double>& overshoots) {
  return static_cast<double>(
      std::count_if(overshoots.begin(), overshoots.end(), [](double us) { return us > 0; }));
}

void AddRow(const std::string& name, const Lane& lane, double floor, cli::TextTable* table) {
  const double solves = static_cast<double>(lane.wall.size());
  table->rows.push_back(
      {name, fmt::format("{:g}", lane.budget_us * 1e-3), fmt::format("{:.0f}", floor),
       Spread(lane.cpu), Spread(lane.wall), Spread(lane.wall_calm), Percent(Over(lane.cpu), solves),
       Percent(Over(lane.wall), solves),
       Percent(solves - static_cast<double>(lane.wall_calm.size()), solves),
       fmt::format("{:.0f}", Median(lane.sweeps)), Percent(lane.not_by_clock, solves),
       fmt::format("{:.4g}", Median(lane.energy)), fmt::format("{:.4g}", Median(lane.residual_max)),
       fmt::format("{:.1e}", lane.largest_error)});
}

/// What a larger budget has to make smaller.
void NoteRises(const std::string& name, const std::vector<Lane>& lanes,
               std::vector<std::string>* notes) {
  const auto compare = [&](const char* what, const Lane& less, const Lane& more, bool rises) {
    if (!rises) return;
    notes->push_back(fmt::format("{}: {} does not fall from {:g} to {:g} ms", name, what,
                                 less.budget_us * 1e-3, more.budget_us * 1e-3));
  };
  for (size_t k = 1; k + 1 < lanes.size(); ++k) {
    const Lane &less = lanes[k - 1], &more = lanes[k];
    compare("residual_energy", less, more, Median(more.energy) >= Median(less.energy));
    compare("residual_max", less, more, Median(more.residual_max) >= Median(less.residual_max));
  }
}

}  // namespace

void PrintBudgets(const BudgetOptions& options, const std::string& command) {
  fmt::print("{}",
             cli::Origin("Budget::Time on frames of the scenes", cli::DescribeContext(command)));
  fmt::print(
      "- times over the budget in us, p50 / p99 / p99.9 / max; negative: inside it; CPU is that of "
      "the calling thread;\n  calm: wall time of the solves that were not preempted\n"
      "- floor: p50 CPU time in us of a Solve() with Budget::Time(0) and min_sweeps = 0\n"
      "- {} solves a row, budgets in turn on each frame; min_sweeps {}, threads {}\n"
      "- check: largest relative difference of residual_energy and Measure(), every {}th solve\n",
      options.solves, options.min_sweeps, options.threads, kCheckEvery);
  cli::TextTable table =
      cli::TableOf({"scene", "budget ms", "floor us", "CPU over us", "wall over us",
                    "calm wall over us", "CPU over %", "wall over %", "preempted %", "sweeps p50",
                    "not by clock %", "energy p50", "max p50", "check"});
  std::vector<std::string> notes;
  for (const SceneChoice& scene : options.scenes) {
    const std::vector<ContactFrame> frames = Record(scene, options);
    const std::string name = NameOf(scene);
    fmt::print("- {}: {} frames from {} on, {} to {} rows, {} bodies\n", name, frames.size(),
               scene.FirstFrame(options.first), frames.front().rows.size(),
               frames.back().rows.size(), frames.back().bodies.size());
    std::fflush(stdout);
    const std::vector<Lane> lanes = SolveAll(frames, options);
    const double floor = Median(lanes.back().cpu);
    for (size_t k = 0; k + 1 < lanes.size(); ++k) AddRow(name, lanes[k], floor, &table);
    NoteRises(name, lanes, &notes);
  }
  fmt::print("\n");
  fmt::print("{}\n", table.ToMarkdown());
  for (const std::string& note : notes) fmt::print("- {}\n", note);
  if (notes.empty()) fmt::print("- medians of the residuals fall with every larger budget\n");
}

}  // namespace cairn::frames
