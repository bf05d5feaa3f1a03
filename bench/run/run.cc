// SPDX-License-Identifier: MIT
#include "run/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "effort/error_sampler.h"
#include "run/solver_run.h"
#include "support/duration.h"
#include "support/machine/metronome.h"
#include "support/sample_plan.h"

namespace cairn::cli {
namespace {

/// Measuring the residual costs about as much as a sweep in each of ten frames; more bodies than
/// this are measured in every fifth frame only.
constexpr int kManyBodies = 400;
constexpr int kSparse = 5;

/// Error against time is measured up to twice the time of a frame, or of the budget [ms].
double LongestSubstep(const RunOptions& options) {
  return std::max(34.0, options.budget ? 2 * Milliseconds(*options.budget) : 0);
}

class SideBySide {
 public:
  SideBySide(const SceneChoice& scene, const RunOptions& options, Metronome* metronome)
      : options_(options),
        plan_(options.samples, options.warmup, options.frames),
        metronome_(metronome) {
    for (const SolverChoice& solver : options.solvers) {
      runs_.push_back(std::make_unique<SolverRun>(scene, solver, options));
    }
    result_.name = scene.info->name;
    result_.description = scene.info->description;
    result_.size = scene.size;
    result_.friction_directions = scene.friction_directions;
    result_.seed = options.seed;
    result_.bodies = static_cast<int>(runs_.front()->world().dynamic_bodies().size());
    result_.joints = static_cast<int>(runs_.front()->world().joints().size());
    result_.warmup = options.warmup;
    result_.beats.emplace_back();
    result_.observed_every = result_.bodies > kManyBodies ? kSparse : 1;
    result_.mass_ratio = MassRatio(runs_.front()->world());
    sampler_ = std::make_unique<ErrorSampler>(options.solvers, runs_.front()->defaults());
    if (options.page) sampler_->AddLadders(options.solvers, LongestSubstep(options));
  }

  void Step(int frame) {
    if (plan_.IsSample(frame) || plan_.IsWarmUp(frame)) Probe(frame);
    const auto observing = frame % result_.observed_every == 0 ? SolverRun::Observing::kOn
                                                               : SolverRun::Observing::kOff;
    const bool disturbed = plan_.IsSample(frame) || plan_.IsWarmUp(frame);
    for (const auto& run : runs_) {
      run->Step(observing);
      if (!disturbed || options_.trace_frame) run->KeepTimeline(options_.trace_frame);
    }
    result_.beats.front().push_back(metronome_->Strike());
  }

  bool AllFailed() const {
    return std::all_of(runs_.begin(), runs_.end(), [](const auto& run) { return run->failed(); });
  }

  SceneResult Finish() {
    if (options_.page) FindScaling();
    result_.bullet_has_zones = runs_.front()->bullet_has_zones();
    for (const auto& run : runs_) result_.solvers.push_back(run->Finish());
    return std::move(result_);
  }

 private:
  void FindScaling() {
    for (const auto& run : runs_) {
      if (run->cairn() == nullptr || run->failed()) continue;
      const ContactProblem problem = run->cairn()->problem();
      Scaling scaling = MeasureScaling(problem);
      if (scaling.rows > 0) result_.scaling = std::move(scaling);
      return;
    }
  }

  void Probe(int frame) {
    const auto source =
        std::find_if(runs_.begin(), runs_.end(), [](const auto& run) { return !run->failed(); });
    if (source == runs_.end()) return;
    std::vector<Effort> efforts;
    for (const auto& run : runs_) efforts.push_back(run->effort());
    if (plan_.IsWarmUp(frame)) {
      (*source)->ProbeNext([this, efforts](bench::Substep* substep, const btContactSolverInfo&) {
        sampler_->WarmUp(substep, efforts);
      });
      return;
    }
    (*source)->ProbeNext([this, efforts, frame, label = (*source)->label()](
                             bench::Substep* substep, const btContactSolverInfo&) {
      const ErrorSampler::Errors errors = sampler_->Measure(substep, efforts);
      for (size_t i = 0; i < runs_.size(); ++i) {
        runs_[i]->AddError(errors.of_solvers[i]);
        if (!errors.curves.empty()) runs_[i]->AddCurve(errors.curves[i]);
      }
      result_.samples.push_back(
          {.frame = frame, .source = label, .reference_residual = errors.reference_residual});
    });
  }

  const RunOptions& options_;
  SamplePlan plan_;
  Metronome* metronome_;
  std::vector<std::unique_ptr<SolverRun>> runs_;
  std::unique_ptr<ErrorSampler> sampler_;
  SceneResult result_;
};

/// Adds what another repetition of a scene found; numbers and pictures stay those of the first.
void AddRepetition(int number, SceneResult again, SceneResult* scene) {
  scene->beats.push_back(std::move(again.beats.front()));
  for (size_t i = 0; i < scene->solvers.size(); ++i) {
    SolverResult& solver = scene->solvers[i];
    solver.repeated.push_back(std::move(again.solvers[i].frames));
    const std::optional<SolverFailure>& failure = again.solvers[i].failure;
    if (!failure || solver.failure) continue;
    solver.failure = {.frame = failure->frame,
                      .reason = fmt::format("in repetition {}: {}", number, failure->reason)};
  }
}

}  // namespace

RunResult Run(const RunOptions& options, const std::string& command) {
  RunResult result{DescribeContext(command),
                   options.budget,
                   options.frames,
                   options.warmup,
                   options.repeat,
                   options.setup,
                   options.noise,
                   {},
                   options.units};

  Progress progress(options.progress);
  Metronome metronome;
  for (int repetition = 1; repetition <= options.repeat; ++repetition) {
    for (size_t i = 0; i < options.scenes.size(); ++i) {
      const SceneChoice& scene = options.scenes[i];
      SideBySide run(scene, options, &metronome);
      for (int frame = 0; frame < options.frames && !run.AllFailed(); ++frame) {
        const std::string of_repetitions =
            options.repeat == 1 ? ""
                                : fmt::format(", repetition {} of {}", repetition, options.repeat);
        // scenes count alike, as nobody knows which is dear
        const double scenes_done = (repetition - 1.0) * static_cast<double>(options.scenes.size()) +
                                   static_cast<double>(i) + 1.0 * frame / options.frames;
        progress.Show(fmt::format("{}: frame {} of {}{}", scene.info->name, frame, options.frames,
                                  of_repetitions),
                      scenes_done / (options.repeat * static_cast<double>(options.scenes.size())));
        run.Step(frame);
      }
      if (repetition == 1) {
        result.scenes.push_back(run.Finish());
      } else {
        AddRepetition(repetition, run.Finish(), &result.scenes[i]);
      }
    }
  }
  return result;
}

}  // namespace cairn::cli
