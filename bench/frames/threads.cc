// SPDX-License-Identifier: MIT
#include <cairn/bullet/constraint_solver.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "frames/experiments.h"
#include "frames/span_times.h"
#include "run/scene_run.h"
#include "support/duration.h"
#include "support/machine/run_context.h"
#include "support/machine/stopwatch.h"
#include "support/statistics.h"
#include "support/text_table.h"

namespace cairn::frames {
namespace {

constexpr int kIterations = 10;

/// A world that Cairn drives with so many threads, and what its steps took [ms].
class ThreadedWorld {
 public:
  ThreadedWorld(const SceneChoice& scene, Work work, int threads)
      : threads_(threads), solver_(SettingsFor(work, threads)), run_(scene, &solver_) {
    run_.world().solver_info().m_numIterations = kIterations;
  }

  /// What threads are busy with, from now on.
  void Record() {
    spans_ =
        std::make_unique<SpanRecorder>(std::min(threads_, SpanRecorder::kMostWorkers), kMostSpans);
    solver_.settings().tuning.spans = spans_.get();
  }

  void Step(bool keep) {
    if (spans_ != nullptr) spans_->Clear();
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
    if (spans_ != nullptr) KeepSpans();
  }

  int threads() const { return threads_; }
  int rows() const {
    int rows = 0;
    for (const IslandReport& island : solver_.report().islands) rows += island.rows;
    return rows;
  }

  std::vector<double> build, solve, write, whole, world;
  /// By SpanKind [us]: of the calling thread, and of all.
  std::array<std::vector<double>, kSpanKinds> caller, all;

 private:
  static constexpr int kMostSpans = 65536;

  void KeepSpans() {
    std::vector<SpanTimes> times;
    for (int worker = 0; worker < spans_->workers(); ++worker) {
      times.emplace_back(spans_->spans(worker));
    }
    for (int k = 0; k < kSpanKinds; ++k) {
      const auto kind = static_cast<SpanKind>(k);
      caller[k].push_back(times[0].of(kind));
      double sum = 0;
      for (const SpanTimes& of_worker : times) sum += of_worker.of(kind);
      all[k].push_back(sum);
    }
  }

  int threads_;
  std::unique_ptr<SpanRecorder> spans_;
  bullet::ConstraintSolver solver_;
  cli::SceneRun run_;
};

using Worlds = std::vector<std::unique_ptr<ThreadedWorld>>;

void PrintBusy(const Worlds& worlds, const std::string& scene) {
  std::vector<std::string> columns = {scene + ": us of"};
  for (const auto& world : worlds) {
    columns.push_back(fmt::format("the caller of {}", world->threads()));
    columns.push_back("all");
  }
  cli::TextTable table = cli::TableOf(std::move(columns));
  std::vector<std::string> together = {"together"};
  for (int k = 0; k < kSpanKinds; ++k) {
    std::vector<std::string> row = {std::string(Describe(static_cast<SpanKind>(k)))};
    double most = 0;
    for (const auto& world : worlds) {
      for (const auto* times : {&world->caller[k], &world->all[k]}) {
        most = std::max(most, cli::Median(*times));
        row.push_back(fmt::format("{:.0f}", cli::Median(*times)));
      }
    }
    if (most >= 0.5) table.rows.push_back(std::move(row));
  }
  for (const auto& world : worlds) {
    for (const auto* kinds : {&world->caller, &world->all}) {
      double sum = 0;
      for (const auto& times : *kinds) sum += cli::Median(times);
      together.push_back(fmt::format("{:.0f}", sum));
    }
  }
  table.rows.push_back(std::move(together));
  fmt::print("{}\n", table.ToMarkdown());
}

}  // namespace

void PrintThreads(const ThreadOptions& options, const std::string& command) {
  fmt::print("{}", cli::Origin(fmt::format("Threads: a substep of {} in worlds of their own",
                                           Describe(options.work)),
                               cli::DescribeContext(command)));
  fmt::print(
      "- {} frames, the worlds in turn; medians, wall clock, ms; ratios to the first number of "
      "threads\n"
      "- solver: build, solve and write; step: that and all of Bullet's own, which is on one "
      "thread\n"
      "- the first number twice: what differs between the two is noise\n{}\n",
      options.window.frames,
      options.parts ? "- us: medians of what threads were busy with; all: their sum, without what "
                      "helpers wait\n"
                    : "");
  cli::TextTable table = cli::TableOf({"scene", "rows", "threads", "build", "solve", "write",
                                       "solver", "step", "ratio, solver", "ratio, step"});
  for (const SceneChoice& scene : options.window.scenes) {
    std::vector<int> counts = options.threads;
    counts.insert(counts.begin() + 1, counts.front());
    Worlds worlds;
    for (const int threads : counts) {
      worlds.push_back(std::make_unique<ThreadedWorld>(scene, options.work, threads));
    }
    const int first = scene.FirstFrame(options.window.frame);
    for (int frame = 0; frame < first + options.window.frames; ++frame) {
      for (const auto& world : worlds) {
        if (frame == first && options.parts) world->Record();
        world->Step(frame >= first);
      }
    }
    if (options.parts) PrintBusy(worlds, NameOf(scene));
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
