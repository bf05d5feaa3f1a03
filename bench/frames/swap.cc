// SPDX-License-Identifier: MIT
#include "frames/swap.h"

#include <cairn/bullet/constraint_solver.h>
#include <fmt/format.h>

#include <array>
#include <chrono>
#include <ctime>
#include <utility>

#include "cli/statistics.h"
#include "frames/frame_solver.h"
#include "frames/markdown.h"
#include "frames/size_series.h"
#include "measure/instrumented_solver.h"

namespace cairn::frames {
namespace {

using bench::Substep;
using cli::Median;

/// CPU time of this thread [us].
double Now() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e6 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_nsec);
}

double Microseconds(std::chrono::nanoseconds time) {
  return 1e-3 * static_cast<double>(time.count());
}

/// What the frames of a scene took [us], and how large they were.
struct Times {
  std::vector<double> bullet, fast, reference;
  std::vector<double> build, solve, write;  ///< of fast
  std::vector<double> points, joint_rows, bodies;
};

class Swap {
 public:
  Swap()
      : fast_(Sweeps(kSweeps, 1)),
        reference_(Sweeps(kSweeps, 1), {.mode = bullet::Mode::kReference}) {}

  void Look(Substep* substep, const btContactSolverInfo& info) {
    btContactSolverInfo ten = info;
    ten.m_numIterations = kSweeps;
    // in turn, so that none always finds the state in the caches
    const std::array<btConstraintSolver*, 3> solvers = {&bullet_, &fast_, &reference_};
    const std::array<std::vector<double>*, 3> to = {&times.bullet, &times.fast, &times.reference};
    for (size_t k = 0; k < solvers.size(); ++k, ++turn_) {
      const size_t lane = turn_ % solvers.size();
      substep->Restore();
      const double start = Now();
      substep->SolveWith(solvers[lane], ten, nullptr);
      to[lane]->push_back(Now() - start);
    }
    ++turn_;
    times.build.push_back(Microseconds(fast_.times().build));
    times.solve.push_back(Microseconds(fast_.times().solve));
    times.write.push_back(Microseconds(fast_.times().write));
    const ContactProblem problem = fast_.problem();
    times.points.push_back(static_cast<double>(problem.points.size()));
    times.joint_rows.push_back(static_cast<double>(problem.rows.size()));
    times.bodies.push_back(static_cast<double>(problem.bodies.size()));
  }

  Times times;

 private:
  static constexpr int kSweeps = 10;

  btSequentialImpulseConstraintSolver bullet_;
  bullet::ConstraintSolver fast_, reference_;
  size_t turn_ = 0;
};

Times TimesOf(const SceneChoice& choice, const SwapOptions& options) {
  btSequentialImpulseConstraintSolver driver;
  bench::InstrumentedSolver instrumented(&driver);
  bench::World world(&instrumented);
  const auto scene = bench::Make(*bench::FindScene(choice.name));
  scene->Build(&world, {.size = choice.size});
  Swap swap;
  const int first = choice.FirstFrame(options.frame);
  for (int frame = 0; frame < first + options.frames; ++frame) {
    if (frame >= first) {
      instrumented.ProbeNext(
          [&](Substep* substep, const btContactSolverInfo& info) { swap.Look(substep, info); });
    }
    scene->BeforeStep(&world, frame);
    world.Step();
  }
  return std::move(swap.times);
}

}  // namespace

void PrintSwaps(const SwapOptions& options, const std::string& command) {
  PrintOrigin("Swap: Cairn instead of Bullet's solver, ten sweeps, no step, one thread", command);
  fmt::print(
      "- {} frames in a row; each is solved by all three from the same state, in turn; medians, "
      "CPU "
      "time\n"
      "- shares: of what the adapter spends on rows, in the core, and on writing back\n\n",
      options.frames);
  MarkdownTable table({"scene", "bodies", "points", "joint rows", "Bullet us", "Cairn us", "ratio",
                       "reference us", "build", "core", "write"});
  for (const SceneChoice& scene : options.scenes) {
    const Times times = TimesOf(scene, options);
    const double bullet = Median(times.bullet), fast = Median(times.fast);
    const double build = Median(times.build), solve = Median(times.solve);
    const double write = Median(times.write), sum = build + solve + write;
    const auto share = [sum](double part) { return fmt::format("{:.0f} %", 100 * part / sum); };
    table.Add({NameOf(scene), fmt::format("{:.0f}", Median(times.bodies)),
               fmt::format("{:.0f}", Median(times.points)),
               fmt::format("{:.0f}", Median(times.joint_rows)), fmt::format("{:.0f}", bullet),
               fmt::format("{:.0f}", fast), fmt::format("{:.1f}", bullet / fast),
               fmt::format("{:.0f}", Median(times.reference)), share(build), share(solve),
               share(write)});
  }
  table.Print();
}

}  // namespace cairn::frames
