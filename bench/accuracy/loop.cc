// SPDX-License-Identifier: MIT
#include "accuracy/loop.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "cli/lane.h"
#include "cli/statistics.h"

namespace cairn::accuracy {
namespace {

/// One solver in one world, and what is added up while it runs.
class Runner {
 public:
  Runner(const cli::SceneChoice& scene, const cli::SolverChoice& solver,
         const cli::RunOptions& options)
      : lane_(scene, solver, options), frames_(options.frames) {}

  void Step(int frame) {
    const bool counts = frame >= frames_ / 2;
    lane_.Step(counts ? cli::Lane::Observing::kOn : cli::Lane::Observing::kOff);
    if (!counts || lane_.failed()) return;
    const bench::SceneFacts facts = lane_.scene().Measure(lane_.world());
    height_.push_back(facts.height_lost_m);
    gap_.push_back(facts.joint_gap_m);
    penetration_.push_back(facts.penetration_m);
    speed_.push_back(facts.speed_at_rest_m_s);
  }

  void Finish(LoopLane* lane) {
    const cli::SolverResult result = lane_.Finish();
    lane->solver = result.label;
    lane->effort = result.effort;
    lane->runs.push_back(result.failure ? Failed() : Figures(result));
    lane->can_fall = lane->can_fall || result.standing.has_value();
    if (result.failure) lane->failures.push_back(result.failure->reason);
    if (result.failure || !result.standing.value_or(true)) ++lane->collapsed;
  }

 private:
  static LoopFigures Failed() {
    LoopFigures figures;
    for (const LoopFigure& figure : kLoopFigures) figures.*figure.value = kInfinity;
    return figures;
  }

  LoopFigures Figures(const cli::SolverResult& result) const {
    std::vector<double> residuals, times, accepted, restored;
    for (size_t i = result.frames.size() / 2; i < result.frames.size(); ++i) {
      const cli::Frame& frame = result.frames[i];
      residuals.push_back(frame.residual);
      times.push_back(frame.time);
      accepted.push_back(frame.steps_accepted);
      restored.push_back(frame.steps_restored);
    }
    return {.height_lost = cli::Mean(height_),
            .joint_gap = cli::Mean(gap_),
            .penetration = cli::Mean(penetration_),
            .residual = cli::Mean(residuals),
            .largest_rest = cli::Largest(speed_),
            .time = cli::Mean(times),
            .accepted = cli::Mean(accepted),
            .restored = cli::Mean(restored)};
  }

  cli::Lane lane_;
  int frames_;
  std::vector<double> height_, gap_, penetration_, speed_;
};

/// A solver, and with which budget.
struct Entry {
  cli::SolverChoice solver;
  cli::RunOptions options;
};

std::vector<Entry> EntriesOf(const LoopOptions& options) {
  std::vector<Entry> entries;
  cli::RunOptions run;
  run.frames = options.frames;
  for (const std::chrono::nanoseconds budget : options.budgets) {
    run.budget = budget;
    for (const char* name : {"cairn", "cairn-pgs"}) {
      entries.push_back({cli::ParseSolvers(name).front(), run});
    }
  }
  run.budget.reset();
  entries.push_back({cli::ParseSolvers("bullet-si").front(), run});
  return entries;
}

}  // namespace

LoopScene RunLoop(const cli::SceneChoice& scene, const LoopOptions& options,
                  const std::function<void(const std::string&)>& show) {
  const std::vector<Entry> entries = EntriesOf(options);
  LoopScene result{.scene = scene, .lanes = std::vector<LoopLane>(entries.size())};
  for (int seed = 1; seed <= options.seeds; ++seed) {
    cli::SceneChoice seeded = scene;
    seeded.seed = static_cast<std::uint64_t>(seed);
    std::vector<std::unique_ptr<Runner>> runners;
    for (const Entry& entry : entries) {
      runners.push_back(std::make_unique<Runner>(seeded, entry.solver, entry.options));
    }
    for (int frame = 0; frame < options.frames; ++frame) {
      show(fmt::format("{}: seed {} of {}, frame {} of {}", scene.info->name, seed, options.seeds,
                       frame, options.frames));
      for (const auto& runner : runners) runner->Step(frame);
    }
    for (size_t i = 0; i < runners.size(); ++i) runners[i]->Finish(&result.lanes[i]);
  }
  return result;
}

}  // namespace cairn::accuracy
