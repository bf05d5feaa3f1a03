// SPDX-License-Identifier: MIT
#include "small/small.h"

#include <fmt/format.h>

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "run/solver_run.h"
#include "scenes/facts.h"
#include "small/same_states.h"
#include "support/machine/cold_caches.h"
#include "support/machine/stopwatch.h"
#include "support/progress.h"
#include "support/sample_plan.h"
#include "support/statistics.h"
#include "worlds/random_world.h"

namespace cairn::cli {
namespace {

/// A world for each solver.
class SolverRuns {
 public:
  explicit SolverRuns(const SceneChoice& scene, const Setup& setup) {
    const RunOptions plain;
    for (SolverChoice solver : SmallSolvers()) {
      solver.threads = setup.threads;
      runs_.push_back(std::make_unique<SolverRun>(scene, solver, plain));
    }
  }

  /// @param caches  emptied before each step, unless there are none
  void Step(int frame, ColdCaches* caches) {
    for (size_t k = 0; k < runs_.size(); ++k) {
      // in turn, so that none always follows the same other one
      SolverRun& run = *runs_[(k + static_cast<size_t>(frame)) % runs_.size()];
      if (caches != nullptr) caches->Empty();
      const ThreadStopwatch stopwatch;
      run.Step(SolverRun::Observing::kOff);
      preempted_[&run].push_back(stopwatch.Read().preempted);
    }
  }

  const bench::World& world() const { return runs_.front()->world(); }

  /// Median time of the frames that count [us]. Once for each solver.
  double Finish(size_t solver, int warmup, std::optional<SolverFailure>* failure) {
    const std::vector<bool>& preempted = preempted_[runs_[solver].get()];
    const SolverResult result = runs_[solver]->Finish();
    if (result.failure) {
      if (!*failure) *failure = result.failure;
      return kNotMeasured;
    }
    std::vector<double> times;
    for (size_t i = static_cast<size_t>(warmup); i < result.frames.size(); ++i) {
      times.push_back(1e3 * result.frames[i].time);
    }
    return Median(Undisturbed(times, {preempted.begin() + warmup, preempted.end()}));
  }

 private:
  std::vector<std::unique_ptr<SolverRun>> runs_;
  std::map<const SolverRun*, std::vector<bool>> preempted_;  ///< In each frame.
};

class SmallRun {
 public:
  SmallRun(const SmallOptions& options, Progress* progress)
      : options_(options), progress_(progress) {}

  SmallResult Run(const SceneChoice& scene) {
    ++world_;
    SmallResult result;
    result.name = NameOf(scene);
    result.size = scene.size;
    result.solvers.resize(SmallSolvers().size());
    Time(scene, nullptr, &SmallSolver::hot, &result);
    if (options_.cold) Time(scene, &caches_, &SmallSolver::cold, &result);
    MeasureErrors(scene, &result);
    return result;
  }

 private:
  void Time(const SceneChoice& scene, ColdCaches* caches, double SmallSolver::*time,
            SmallResult* result) {
    SolverRuns runs(scene, options_.setup);
    result->bodies = static_cast<int>(runs.world().dynamic_bodies().size());
    result->joints = static_cast<int>(runs.world().joints().size());
    std::vector<double> points;
    for (int frame = 0; frame < options_.frames; ++frame) {
      Show(scene, caches == nullptr ? "hot" : "cold", frame);
      runs.Step(frame, caches);
      if (frame >= options_.warmup) points.push_back(bench::ContactPoints(runs.world()));
    }
    result->points = Median(points);
    for (size_t i = 0; i < result->solvers.size(); ++i) {
      SmallSolver& solver = result->solvers[i];
      solver.*time = runs.Finish(i, options_.warmup, &solver.failure);
    }
  }

  void MeasureErrors(const SceneChoice& scene, SmallResult* result) {
    const SamplePlan plan(options_.samples, options_.warmup, options_.frames);
    if (plan.samples() == 0) return;
    SameStates states(scene, options_.setup);
    for (int frame = 0; frame < options_.frames; ++frame) {
      Show(scene, "errors", frame);
      plan.IsSample(frame) ? states.Measure(result) : states.Step();
    }
  }

  std::string NameOf(const SceneChoice& scene) const {
    return std::string(options_.random ? bench::KindOf(static_cast<std::uint64_t>(scene.size)).name
                                       : scene.info->name);
  }

  void Show(const SceneChoice& scene, const char* what, int frame) {
    progress_->Show(fmt::format("{} ({} of {}), {}: frame {} of {}", NameOf(scene), world_,
                                options_.worlds.size(), what, frame, options_.frames));
  }

  const SmallOptions& options_;
  Progress* progress_;
  ColdCaches caches_;
  int world_ = 0;  ///< Counted from 1.
};

}  // namespace

std::vector<SmallResult> RunSmall(const SmallOptions& options) {
  Progress progress(options.progress);
  SmallRun run(options, &progress);
  std::vector<SmallResult> results;
  for (const SceneChoice& scene : options.worlds) results.push_back(run.Run(scene));
  return results;
}

}  // namespace cairn::cli
