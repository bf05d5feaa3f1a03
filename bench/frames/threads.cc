// SPDX-License-Identifier: MIT
#include <cairn/bullet/constraint_solver.h>
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "frames/experiments.h"
#include "run/scene_run.h"
#include "support/duration.h"
#include "support/machine/run_context.h"
#include "support/machine/stopwatch.h"
#include "support/statistics.h"
#include "support/text_table.h"

namespace cairn::frames {
namespace {

constexpr int kSweeps = 10;

/// A world that Cairn drives with so many threads, and what its steps took [ms].
class ThreadedWorld {
 public:
  ThreadedWorld(const SceneChoice& scene, int threads)
      : threads_(threads), solver_(Sweeps(kSweeps, threads)), run_(scene, &solver_) {
    run_.world().solver_info().m_numIterations = kSweeps;
  }

  void Step(bool keep) {
    const cli::ThreadStopwatch stopwatch;
    run_.Step();
    const double step = stopwatch.Read().wall;
    if (!keep) return;
    const bullet::SubstepTimes times = solver_.times();
    build.push_back(cli::Milliseconds(times.build));
    solve.push_back(cli::Milliseconds(times.solve));
    write.push_back(cli::Milliseconds(times.write));
    whole.push_back(build.back() + solve.back() + write.back());
    world.push_back(step);
  }

  int threads() const { return threads_; }
  int rows() const {
    int rows = 0;
    for (const IslandReport& island : solver_.report().islands) rows += island.rows;
    return rows;
  }

  std::vector<double> build, solve, write, whole, world;

 private:
  int threads_;
  bullet::ConstraintSolver solver_;
  cli::SceneRun run_;
};

}  // namespace

void PrintThreads(const ThreadOptions& options, const std::string& command) {
  fmt::print("{}", cli::Origin("Threads: a substep of ten plain sweeps in worlds of their own",
                               cli::DescribeContext(command)));
  fmt::print(
      "- {} frames, the worlds in turn; medians, wall clock, ms; ratios to the first number of "
      "threads\n"
      "- solver: build, solve and write; step: that and all of Bullet's own, which is on one "
      "thread\n"
      "- the first number twice: what differs between the two is noise\n\n",
      options.window.frames);
  cli::TextTable table = cli::TableOf({"scene", "rows", "threads", "build", "solve", "write",
                                       "solver", "step", "ratio, solver", "ratio, step"});
  for (const SceneChoice& scene : options.window.scenes) {
    std::vector<int> counts = options.threads;
    counts.insert(counts.begin() + 1, counts.front());
    std::vector<std::unique_ptr<ThreadedWorld>> worlds;
    for (const int threads : counts) {
      worlds.push_back(std::make_unique<ThreadedWorld>(scene, threads));
    }
    const int first = scene.FirstFrame(options.window.frame);
    for (int frame = 0; frame < first + options.window.frames; ++frame) {
      for (const auto& world : worlds) world->Step(frame >= first);
    }
    for (const auto& world : worlds) {
      const auto ms = [](const std::vector<double>& times) {
        return fmt::format("{:.3f}", cli::Median(times));
      };
      const auto ratio = [](const std::vector<double>& base, const std::vector<double>& times) {
        return fmt::format("{:.2f}", cli::Median(base) / cli::Median(times));
      };
      table.rows.push_back(
          {NameOf(scene), fmt::format("{}", world->rows()), fmt::format("{}", world->threads()),
           ms(world->build), ms(world->solve), ms(world->write), ms(world->whole), ms(world->world),
           ratio(worlds[0]->whole, world->whole), ratio(worlds[0]->world, world->world)});
    }
  }
  fmt::print("{}\n", table.ToMarkdown());
}

}  // namespace cairn::frames
