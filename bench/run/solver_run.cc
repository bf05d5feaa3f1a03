// SPDX-License-Identifier: MIT
#include "run/solver_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cairn/contact_problem.h"
#include "support/duration.h"

namespace cairn::cli {
namespace {

/// A budget that is given holds for solvers with a clock, unless they have iterations of their own.
Effort InitialEffort(const SolverChoice& choice, const RunOptions& options) {
  const IterationRule rule = choice.own_iterations.value_or(options.iterations);
  Effort effort;
  if (rule.kind == IterationRule::Kind::kFixed) effort.iterations = rule.count;
  if (choice.entry->control == Control::kClock && !choice.own_iterations) {
    effort.budget = options.budget;
    effort.units = options.units;
  }
  return effort;
}

bool IsFitted(const SolverChoice& choice, const RunOptions& options) {
  return choice.own_iterations.value_or(options.iterations).kind == IterationRule::Kind::kFit &&
         choice.entry->control == Control::kIterations;
}

std::string Describe(const Effort& effort, Control control) {
  if (control == Control::kNone) return "until done";
  if (effort.budget || effort.units) return FormatBudget({effort.budget, effort.units});
  return fmt::format("{} iterations", effort.iterations);
}

/// Adds a solved group to what was observed in its frame.
void Observe(const ContactProblem& problem, std::span<const double> impulses, Frame* frame) {
  const Report report = Measure(problem, impulses);
  if (report.status == Status::kEmptyProblem) return;
  frame->residual = std::max(frame->residual, report.ok() ? report.residual_max : kInfinity);
  for (const IslandReport& island : report.islands) {
    frame->rows += island.rows;
    frame->islands += island.rows > 0;
  }
}

}  // namespace

SolverRun::SolverRun(const SceneChoice& scene, const SolverChoice& choice,
                     const RunOptions& options)
    : contestant_(choice.Make()),
      watched_(contestant_->solver()),
      world_(&watched_),
      scene_(scene.make()),
      effort_(InitialEffort(choice, options)),
      parts_(choice.entry->parts) {
  scene_->Build(&world_, scene.options());
  defaults_ = world_.solver_info();
  watched_.Watch(world_.bullet());
  result_.label = choice.label;
  result_.counts_iterations = choice.entry->control != Control::kNone;
  result_.is_ours = choice.entry->maker == Maker::kCairn;
  result_.effort = Describe(effort_, choice.entry->control);
  if (IsFitted(choice, options)) {
    fit_.emplace(*options.budget);
    result_.effort = "iterations that fit " + FormatDuration(*options.budget);
  }
  if (options.timelines) {
    timeline_.emplace(contestant_->threads());
    contestant_->RecordSpans(timeline_->spans());
  }
  if (options.page) animation_.emplace().Take(world_);
}

void SolverRun::ProbeNext(bench::InstrumentedSolver::Probe probe) {
  watched_.ProbeNext(std::move(probe));
  probing_ = true;
}

void SolverRun::RecordNext(const std::string& path, int frame) {
  writer_.Ask(path, frame, cairn(), &watched_);
  if (cairn() == nullptr) probing_ = true;
}

void SolverRun::Prepare(Observing observing) {
  btContactSolverInfo info = defaults_;
  contestant_->Begin(effort_, &info);
  if (std::exchange(probing_, false)) info.m_minimumSolverBatchSize = 1;
  world_.solver_info() = info;

  observed_ = {};
  if (observing == Observing::kOff) {
    contestant_->Observe(nullptr);
    return;
  }
  observed_.residual = 0;  // of a world in which nothing touches
  contestant_->Observe([this](const ContactProblem& problem, std::span<const double> impulses) {
    const auto begin = Span::Clock::now();
    cli::Observe(problem, impulses, &observed_);
    if (timeline_) timeline_->AddOwn("the tool measures; not counted", begin);
  });
}

void SolverRun::Step(Observing observing) {
  if (failed()) return;
  Prepare(observing);
  scene_->BeforeStep(&world_, static_cast<int>(result_.frames.size()));
  if (timeline_) timeline_->Begin();
  world_.Step(parts_);
  if (timeline_) timeline_->End();
  const std::chrono::nanoseconds time = watched_.TakeTime() - contestant_->TakeObservingTime();
  if (fit_) {
    fit_->Learn(time);
    effort_.iterations = fit_->iterations();
  }
  Record(time);
}

void SolverRun::Record(std::chrono::nanoseconds time) {
  const int frame = static_cast<int>(result_.frames.size());
  if (const std::string refusal = contestant_->refusal(); !refusal.empty()) {
    result_.failure = {.frame = frame, .reason = refusal};
    return;  // what was timed is not this solver
  }
  const Work work = contestant_->work();
  result_.frames.push_back({.time = Milliseconds(time),
                            .iterations = work.iterations,
                            .residual = observed_.residual,
                            .steps_accepted = work.steps_accepted,
                            .steps_restored = work.steps_restored,
                            .factorisations = work.factorisations,
                            .guarded = work.guarded,
                            .rows = observed_.rows / parts_,
                            .islands = observed_.islands / parts_,
                            .facts = {}});
  if (!watched_.failure().empty()) {
    result_.failure = {.frame = frame, .reason = watched_.failure()};
    return;
  }
  if (!animation_) return;
  animation_->Take(world_);
  result_.frames.back().facts = ReadFrameFacts(*scene_, world_);
}

void SolverRun::KeepTimeline(std::optional<int> wanted) {
  if (!timeline_ || failed()) return;
  const int frame = static_cast<int>(result_.frames.size()) - 1;
  const double time = result_.frames.back().time;
  const bool keep = wanted ? *wanted == frame : time > result_.timeline.time;
  if (keep) result_.timeline = timeline_->Read(frame, time);
}

SolverResult SolverRun::Finish() {
  result_.fallback_share = contestant_->fallback_share();
  if (animation_) result_.animation = animation_->Finish();
  if (!failed()) ReadFacts(*scene_, world_, &result_);
  return std::move(result_);
}

}  // namespace cairn::cli
