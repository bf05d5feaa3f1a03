// SPDX-License-Identifier: MIT
#include "accuracy/loop/loop.h"

#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <ratio>
#include <utility>

#include "contestants/cairn_contestants.h"
#include "contestants/solver_registry.h"
#include "run/solver_run.h"
#include "support/statistics.h"

namespace cairn::accuracy {
namespace {

/// One solver in one world, and what is added up while it runs.
class Runner {
 public:
  Runner(const cli::SceneChoice& scene, const cli::SolverChoice& solver,
         const cli::RunOptions& options)
      : run_(scene, solver, options), frames_(options.frames) {}

  void Step(int frame) {
    const bool counts = frame >= frames_ / 2;
    run_.Step(counts ? cli::SolverRun::Observing::kOn : cli::SolverRun::Observing::kOff);
    if (!counts || run_.failed()) return;
    const bench::SceneFacts facts = run_.scene().Measure(run_.world());
    height_.push_back(facts.height_lost_m);
    gap_.push_back(facts.joint_gap_m);
    penetration_.push_back(facts.penetration_m);
    speed_.push_back(facts.speed_at_rest_m_s);
  }

  void Finish(LoopSolver* solver) {
    const cli::SolverResult result = run_.Finish();
    solver->name = result.label;
    solver->effort = result.effort;
    solver->runs.push_back(result.failure ? Failed() : Figures(result));
    solver->can_fall = solver->can_fall || result.standing.has_value();
    if (result.failure) solver->failures.push_back(result.failure->reason);
    if (result.failure || !result.standing.value_or(true)) ++solver->collapsed;
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

  cli::SolverRun run_;
  int frames_;
  std::vector<double> height_, gap_, penetration_, speed_;
};

/// A solver, and with which budget.
struct Entry {
  cli::SolverChoice solver;
  cli::RunOptions options;
};

std::unique_ptr<cli::Contestant> MakeSweeps() {
  return std::make_unique<cli::CairnContestant>(Settings{.method = Method::kPgs});
}

std::unique_ptr<cli::Contestant> MakeAccelerated() {
  return std::make_unique<cli::CairnContestant>(Settings{.k_sm = 0});
}

std::unique_ptr<cli::Contestant> MakeSteps() {
  return std::make_unique<cli::CairnContestant>(Settings{});
}

cli::SolverChoice ChoiceOf(Kind kind) {
  using cli::Control, cli::Maker, cli::SolverEntry;
  static const std::array<SolverEntry, kKinds.size()> entries = {
      SolverEntry{"sweeps", "", Maker::kCairn, Control::kClock, &MakeSweeps},
      SolverEntry{"accelerated", "", Maker::kCairn, Control::kClock, &MakeAccelerated},
      SolverEntry{"steps", "", Maker::kCairn, Control::kClock, &MakeSteps}};
  return {.entry = &entries[static_cast<size_t>(kind)],
          .own_iterations = {},
          .label = entries[static_cast<size_t>(kind)].name};
}

std::vector<Entry> EntriesOf(const LoopOptions& options) {
  std::vector<Entry> entries;
  cli::RunOptions run;
  run.frames = options.frames;
  for (const std::chrono::nanoseconds budget : options.budgets) {
    run.budget = budget;
    for (const Kind kind : kKinds) entries.push_back({ChoiceOf(kind), run});
  }
  run.budget.reset();
  entries.push_back({cli::ParseSolvers("bullet-si").front(), run});
  return entries;
}

/// All solvers on one scene with one seed, side by side.
void RunSeed(int seed, const std::vector<Entry>& entries,
             const std::function<void(int frame)>& show, LoopScene* scene) {
  cli::SceneChoice seeded = scene->scene;
  seeded.seed = static_cast<std::uint64_t>(seed);
  std::vector<std::unique_ptr<Runner>> runners;
  for (const Entry& entry : entries) {
    runners.push_back(std::make_unique<Runner>(seeded, entry.solver, entry.options));
  }
  for (int frame = 0; frame < entries.front().options.frames; ++frame) {
    show(frame);
    for (const auto& runner : runners) runner->Step(frame);
  }
  for (size_t i = 0; i < runners.size(); ++i) runners[i]->Finish(&scene->solvers[i]);
}

}  // namespace

std::vector<LoopScene> RunLoops(const LoopOptions& options,
                                const std::function<void(const std::string&)>& show,
                                const std::function<bool()>& stop) {
  const std::vector<Entry> entries = EntriesOf(options);
  std::vector<LoopScene> scenes;
  for (const cli::SceneChoice& scene : options.scenes) {
    scenes.push_back({.scene = scene, .solvers = std::vector<LoopSolver>(entries.size())});
  }
  const auto begin = std::chrono::steady_clock::now();
  const size_t runs = scenes.size() * static_cast<size_t>(options.seeds);
  size_t done = 0;
  std::string left;
  for (bool stopped = false; done < runs && !stopped; stopped = stop()) {
    LoopScene& scene = scenes[done % scenes.size()];
    const int seed = 1 + static_cast<int>(done / scenes.size());
    const auto say = [&](int frame) {
      show(fmt::format("seed {} of {}, {}: frame {} of {}{}", seed, options.seeds,
                       scene.scene.info->name, frame, options.frames, left));
    };
    RunSeed(seed, entries, say, &scene);
    if (++done % scenes.size() != 0) continue;  // scenes differ too much to foresee anything
    const std::chrono::duration<double, std::ratio<60>> spent =
        std::chrono::steady_clock::now() - begin;
    left = fmt::format(", about {:.0f} min left", spent.count() * static_cast<double>(runs - done) /
                                                      static_cast<double>(done));
  }
  std::erase_if(scenes, [](const LoopScene& scene) { return scene.seeds() == 0; });
  return scenes;
}

}  // namespace cairn::accuracy
