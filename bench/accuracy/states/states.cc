// SPDX-License-Identifier: MIT
#include "accuracy/states/states.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <string_view>
#include <utility>

#include "run/scene_run.h"
#include "support/sample_plan.h"
#include "support/statistics.h"

namespace cairn::accuracy {
namespace {

/// Frames in which memory is allocated and prices are learnt.
constexpr int kLearning = 10;
/// A sample that was interrupted moves to the next frame, so often at most: a shadow must see each
/// frame once.
constexpr int kTries = 8;

/// Times of Bullet's parts.
class BulletTimes {
 public:
  explicit BulletTimes(size_t most) : most_(most) {}

  void Add(const BulletTime& time) {
    if (times_.size() == most_) times_.erase(times_.begin());
    times_.push_back(time);
  }
  BulletTime Median() const {
    return {.set_up = MedianOf(&BulletTime::set_up),
            .split = MedianOf(&BulletTime::split),
            .iterations = MedianOf(&BulletTime::iterations),
            .finish = MedianOf(&BulletTime::finish)};
  }

 private:
  double MedianOf(double BulletTime::*part) const {
    std::vector<double> values;
    for (const BulletTime& time : times_) values.push_back(time.*part);
    return cli::Median(values);
  }

  size_t most_;
  std::vector<BulletTime> times_;
};

/// The solvers of a scene, which live as long as it does.
class StateMeter {
 public:
  explicit StateMeter(const StatesOptions& options)
      : options_(options), recent_(static_cast<size_t>(options.rounds)) {}

  /// Every frame of the run, once: the shadows solve it in Bullet's time, in turn.
  void Pass(const bench::Substep& substep, const btContactSolverInfo& info) {
    recent_.Add(bullet_.Solve(substep, info, options_.iterations));
    Shade(substep, info, recent_.Median(), [](Kind) {});
  }

  /// The same, and what they made of it is kept.
  StateResult Sample(const bench::Substep& substep, const btContactSolverInfo& info) {
    BulletTimes times(static_cast<size_t>(options_.rounds));
    for (int i = 0; i < options_.rounds; ++i) {
      times.Add(bullet_.Solve(substep, info, options_.iterations));
      recent_.Add(times.Median());
    }
    StateResult result;
    result.bullet_time = times.Median();
    const RecordedSubstep recorded = bullet_.Record(substep, info);
    result.bodies = static_cast<int>(recorded.frame.bodies.size());
    result.rows = static_cast<int>(recorded.frame.rows.size());
    Shade(substep, info, result.bullet_time,
          [&](Kind kind) { changes_[static_cast<size_t>(kind)] = recorded.Changes(); });
    for (size_t k = 0; k < kKinds.size(); ++k) result.cairn[k].frame = frames_[k];
    return result;
  }

  /// Fills in the errors of the last Sample().
  void Judge(const bench::Substep& substep, const btContactSolverInfo& info, StateResult* result) {
    const bench::ContactFrame frame = bullet_.Record(substep, info).frame;
    const bench::VelocityNorm norm(frame.bodies);
    result->reference = bench::Converge(frame, norm, 1e6 * options_.reference);
    const std::vector<Velocity> truth = std::exchange(result->reference.velocities, {});
    const auto error = [&](std::span<const Velocity> v) { return norm.Between(v, truth); };
    for (size_t k = 0; k < kKinds.size(); ++k) result->cairn[k].error = error(changes_[k]);
    FollowBullet(substep, info, error, result);
  }

  /// What the shadow with steps did last.
  const ShadowFrame& steps() const { return frames_[static_cast<size_t>(Kind::kSteps)]; }

 private:
  template <class Look>
  void Shade(const bench::Substep& substep, const btContactSolverInfo& info, const BulletTime& time,
             Look look) {
    // in turn, so that none always finds the state in the caches
    for (size_t i = 0; i < kKinds.size(); ++i) {
      const size_t k = (i + turn_) % kKinds.size();
      frames_[k] = shadows_[k].Solve(substep, info, time.total());
      look(kKinds[k]);
    }
    ++turn_;
  }

  /// Until Bullet is as good as the best of the others.
  template <class Error>
  void FollowBullet(const bench::Substep& substep, const btContactSolverInfo& info, Error error,
                    StateResult* result) {
    bullet_.Follow(substep, info, options_.most,
                   [&](int iteration, std::span<const Velocity> velocities) {
                     result->followed = iteration;
                     result->last_error = error(velocities);
                     if (iteration == 0) result->start_error = result->last_error;
                     if (iteration == options_.iterations)
                       result->bullet_error = result->last_error;
                     bool all_matched = true;
                     for (CairnResult& cairn : result->cairn) {
                       const bool matches = result->last_error.rms <= cairn.error.rms;
                       if (!cairn.worth && matches) cairn.worth = iteration;
                       all_matched = all_matched && cairn.worth.has_value();
                     }
                     return !all_matched || iteration < options_.iterations;
                   });
  }

  const StatesOptions& options_;
  BulletTrial bullet_;
  BulletTimes recent_;
  std::array<Shadow, kKinds.size()> shadows_ = {Shadow(SettingsOf(Kind::kSweeps)),
                                                Shadow(SettingsOf(Kind::kAccelerated)),
                                                Shadow(SettingsOf(Kind::kSteps))};
  std::array<ShadowFrame, kKinds.size()> frames_;
  std::array<std::vector<Velocity>, kKinds.size()> changes_;
  size_t turn_ = 0;
};

/// Goes through a run, and decides which of its frames are sampled.
class Walk {
 public:
  Walk(const cli::SceneChoice& scene, const StatesOptions& options)
      : plan_(options.samples, 0, options.frames),
        run_(scene, options.advance),
        meter_(options),
        result_{.scene = scene, .states = {}, .empty = 0, .frames = {}} {}

  int frame() const { return run_.frame(); }
  bool IsSample() const { return due_ || plan_.IsSample(frame()); }

  void Step() {
    if (plan_.IsSample(frame())) {
      due_ = true;
      tries_ = 0;
    }
    run_.StepAfter([this, at = frame()](bench::Substep* substep, const btContactSolverInfo& info) {
      if (due_) {
        Sample(*substep, info, at);
      } else {
        meter_.Pass(*substep, info);
      }
      if (at >= kLearning && !meter_.steps().empty) result_.frames.push_back(meter_.steps());
    });
  }

  SceneStates Take() { return std::move(result_); }

 private:
  void Sample(const bench::Substep& substep, const btContactSolverInfo& info, int at) {
    StateResult state = meter_.Sample(substep, info);
    const bool last = ++tries_ == kTries || plan_.IsSample(at + 1);
    if (state.Interrupted() && !last) return;
    due_ = false;
    if (state.rows == 0) {
      ++result_.empty;
      return;
    }
    meter_.Judge(substep, info, &state);
    state.frame = at;
    result_.states.push_back(std::move(state));
  }

  cli::SamplePlan plan_;
  cli::StateRun run_;
  StateMeter meter_;
  bool due_ = false;  ///< A sample is.
  int tries_ = 0;
  SceneStates result_;
};

constexpr std::pair<std::string_view, double> kGoals[] = {
    {"chain", 0.01}, {"bridge", 0.1}, {"heavy-top", 0.1}, {"tower", 0.1},  {"pyramid", 0.2},
    {"wall", 0.2},   {"castle", 0.2}, {"rubble", 1},      {"ragdolls", 1}, {"islands", 1},
};

}  // namespace

double GoalOf(std::string_view scene) {
  for (const auto& [name, share] : kGoals) {
    if (name == scene) return share;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double StateResult::LeastError() const {
  double least = bullet_error.rms;
  for (const CairnResult& result : cairn) least = std::min(least, result.error.rms);
  return least;
}

bool StateResult::StepsAreWorseThan(Kind other) const {
  return Of(Kind::kSteps).error.rms > 1.05 * Of(other).error.rms + reference.spread.rms;
}

bool StateResult::Interrupted() const {
  return std::any_of(cairn.begin(), cairn.end(),
                     [](const CairnResult& result) { return result.frame.time.preempted; });
}

SceneStates MeasureStates(const cli::SceneChoice& scene, const StatesOptions& options,
                          const std::function<void(const std::string&)>& show) {
  Walk walk(scene, options);
  while (walk.frame() < options.frames) {
    show(fmt::format("{}: frame {} of {}{}", scene.info->name, walk.frame(), options.frames,
                     walk.IsSample() ? ", measuring" : ""));
    walk.Step();
  }
  return walk.Take();
}

}  // namespace cairn::accuracy
