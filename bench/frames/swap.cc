// SPDX-License-Identifier: MIT
#include "frames/experiments.h"

#include <cairn/bullet/constraint_solver.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "frames/span_times.h"
#include "measure/instrumented_solver.h"
#include "run/scene_run.h"
#include "support/machine/run_context.h"
#include "support/machine/stopwatch.h"
#include "support/statistics.h"
#include "support/text_table.h"

namespace cairn::frames {
namespace {

using bench::Substep;
using cli::Median;

/// Where a substep of Cairn went, wall clock [us].
struct Parts {
  double set_up = 0;  ///< from Bullet's objects to blocks
  double sweeps = 0;  ///< with the residuals that the report gives
  double finish = 0;  ///< from blocks to Bullet's objects
};

Parts PartsOf(const SpanTimes& times) {
  Parts parts;
  parts.set_up = times.of(SpanKind::kRead) + times.of(SpanKind::kSetUp);
  parts.finish = times.of(SpanKind::kResults) + times.of(SpanKind::kWrite);
  parts.sweeps = times.together() - parts.set_up - parts.finish;
  return parts;
}

/// What the frames of a scene took [us], and how large they were.
struct Times {
  std::vector<double> bullet, fast, reference;
  std::vector<double> set_up, sweeps, finish;  ///< of fast
  std::vector<double> set_up_ns;               ///< likewise, for each point and joint row
  std::vector<double> points, joint_rows, bodies;
};

class Swap {
 public:
  Swap()
      : fast_(Sweeps(kSweeps, 1)),
        reference_(Sweeps(kSweeps, 1), {.mode = bullet::Mode::kReference}) {
    fast_.settings().tuning.spans = &spans_;
  }

  void Look(Substep* substep, const btContactSolverInfo& info) {
    btContactSolverInfo ten = info;
    ten.m_numIterations = kSweeps;
    // in turn, so that none always finds the state in the caches
    const std::array<btConstraintSolver*, 3> solvers = {&bullet_, &fast_, &reference_};
    const std::array<std::vector<double>*, 3> to = {&times.bullet, &times.fast, &times.reference};
    for (size_t k = 0; k < solvers.size(); ++k, ++turn_) {
      const size_t who = turn_ % solvers.size();
      substep->Restore();
      spans_.Clear();
      const cli::ThreadStopwatch stopwatch;
      substep->SolveWith(solvers[who], ten, nullptr);
      to[who]->push_back(1e3 * stopwatch.Read().cpu);
      if (solvers[who] == &fast_) AddParts();
    }
    ++turn_;
  }

  Times times;

 private:
  static constexpr int kSweeps = 10;
  static constexpr int kMostSpans = 65536;

  void AddParts() {
    const Parts parts = PartsOf(SpanTimes(spans_.spans(0)));
    times.set_up.push_back(parts.set_up);
    times.sweeps.push_back(parts.sweeps);
    times.finish.push_back(parts.finish);
    const ContactProblem problem = fast_.problem();
    const auto points = static_cast<double>(problem.points.size());
    const auto joint_rows = static_cast<double>(problem.rows.size() + problem.joint_rows.size());
    times.points.push_back(points);
    times.joint_rows.push_back(joint_rows);
    times.bodies.push_back(static_cast<double>(problem.bodies.size()));
    times.set_up_ns.push_back(1e3 * parts.set_up / std::max(1.0, points + joint_rows));
  }

  SpanRecorder spans_{1, kMostSpans};
  btSequentialImpulseConstraintSolver bullet_;
  bullet::ConstraintSolver fast_, reference_;
  size_t turn_ = 0;
};

Times TimesOf(const SceneChoice& choice, const WindowOptions& options) {
  btSequentialImpulseConstraintSolver driver;
  cli::SceneRun run(choice, &driver);
  Swap swap;
  run.Skip(choice.FirstFrame(options.frame));
  for (int i = 0; i < options.frames; ++i) {
    run.StepAfter(
        [&](Substep* substep, const btContactSolverInfo& info) { swap.Look(substep, info); });
  }
  return std::move(swap.times);
}

}  // namespace

void PrintSwaps(const WindowOptions& options, const std::string& command) {
  fmt::print("{}",
             cli::Origin("Swap: Cairn instead of Bullet's solver, ten sweeps, no step, one thread",
                         cli::DescribeContext(command)));
  fmt::print(
      "- {} frames in a row; each is solved by all three from the same state, in turn; medians, "
      "CPU "
      "time\n"
      "- shares: set-up, from Bullet's objects to blocks; sweeps; finish, back to the objects\n"
      "- set-up ns: for each point of contact and each joint row\n\n",
      options.frames);
  cli::TextTable table =
      cli::TableOf({"scene", "bodies", "points", "joint rows", "Bullet us", "Cairn us", "ratio",
                    "reference us", "set-up", "sweeps", "finish", "set-up ns"});
  for (const SceneChoice& scene : options.scenes) {
    const Times times = TimesOf(scene, options);
    const double bullet = Median(times.bullet), fast = Median(times.fast);
    const double set_up = Median(times.set_up), sweeps = Median(times.sweeps);
    const double finish = Median(times.finish), sum = set_up + sweeps + finish;
    const auto share = [sum](double part) { return fmt::format("{:.0f} %", 100 * part / sum); };
    table.rows.push_back(
        {NameOf(scene), fmt::format("{:.0f}", Median(times.bodies)),
         fmt::format("{:.0f}", Median(times.points)),
         fmt::format("{:.0f}", Median(times.joint_rows)), fmt::format("{:.0f}", bullet),
         fmt::format("{:.0f}", fast), fmt::format("{:.1f}", bullet / fast),
         fmt::format("{:.0f}", Median(times.reference)), share(set_up), share(sweeps),
         share(finish), fmt::format("{:.0f}", Median(times.set_up_ns))});
  }
  fmt::print("{}\n", table.ToMarkdown());
}

}  // namespace cairn::frames
