// SPDX-License-Identifier: MIT
#include "accuracy/states.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "accuracy/state_run.h"
#include "cli/sample_plan.h"
#include "cli/statistics.h"

namespace cairn::accuracy {
namespace {

/// Rounds that are not kept: memory is allocated, prices are learnt.
constexpr int kWarmUps = 2;

/// The solvers of a scene. Cairn's live through all of its states.
class StateMeter {
 public:
  explicit StateMeter(const StatesOptions& options) : options_(options) {}

  StateResult Measure(bench::Substep* substep, const btContactSolverInfo& info,
                      const bench::ContactFrame& before, const bench::ContactFrame& frame) {
    const VelocityNorm norm(frame.bodies);
    StateResult result;
    result.bodies = static_cast<int>(frame.bodies.size());
    result.rows = static_cast<int>(frame.rows.size());
    result.reference = Converge(frame, norm, 1e6 * options_.reference);
    const std::vector<Velocity> truth = std::exchange(result.reference.velocities, {});

    const auto error = [&](std::span<const Velocity> v) { return norm.Between(v, truth); };
    Compare(*substep, info, before, frame, error, &result);
    result.floor = SolveFloor(before, frame, options_.rounds);
    FollowBullet(*substep, info, error, &result);
    return result;
  }

 private:
  /// Times of Bullet's parts on one state.
  struct Times {
    std::vector<double> set_up, split, iterations, finish;

    void Add(const BulletTime& time) {
      set_up.push_back(time.set_up);
      split.push_back(time.split);
      iterations.push_back(time.iterations);
      finish.push_back(time.finish);
    }
    BulletTime Median() const {
      return {cli::Median(set_up), cli::Median(split), cli::Median(iterations),
              cli::Median(finish)};
    }
  };

  /// All solvers in turn, so that what the machine does meanwhile happens to all.
  template <class Error>
  void Compare(const bench::Substep& substep, const btContactSolverInfo& info,
               const bench::ContactFrame& before, const bench::ContactFrame& frame, Error error,
               StateResult* result) {
    Times times;
    for (int i = 0; i <= options_.rounds; ++i) {
      const BulletTime time = bullet_.Solve(substep, info, options_.iterations);
      if (i > 0) times.Add(time);
    }
    result->bullet_time = times.Median();
    for (int round = -kWarmUps; round < options_.rounds; ++round) {
      for (size_t k = 0; k < kShares.size() * kKinds.size(); ++k) {
        const size_t at = (k + static_cast<size_t>(round + kWarmUps)) % (kShares.size() * 2);
        CairnTrial& trial = trials_[at / 2][at % 2];
        trial.Round(before, frame, result->Budget(kShares[at / 2]));
        if (round >= 0) trial.Keep(error(trial.velocities()));
      }
      times.Add(bullet_.Solve(substep, info, options_.iterations));
      result->bullet_time = times.Median();
    }
    for (size_t s = 0; s < kShares.size(); ++s) {
      for (size_t k = 0; k < kKinds.size(); ++k) result->cairn[s][k] = trials_[s][k].Take();
    }
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
                     for (auto& of_share : result->cairn) {
                       for (CairnResult& cairn : of_share) {
                         const bool matches = result->last_error.rms <= cairn.error.rms;
                         if (!cairn.worth && matches) cairn.worth = iteration;
                         all_matched = all_matched && cairn.worth.has_value();
                       }
                     }
                     return !all_matched || iteration < options_.iterations;
                   });
  }

  const StatesOptions& options_;
  BulletTrial bullet_;
  std::array<std::array<CairnTrial, kKinds.size()>, kShares.size()> trials_ = {
      {{CairnTrial(Kind::kSweeps), CairnTrial(Kind::kSteps)},
       {CairnTrial(Kind::kSweeps), CairnTrial(Kind::kSteps)}}};
};

}  // namespace

double StateResult::LeastError() const {
  double least = bullet_error.rms;
  for (const auto& of_share : cairn) {
    for (const CairnResult& result : of_share) least = std::min(least, result.error.rms);
  }
  return least;
}

bool StateResult::WorseThanSweeps(Share share) const {
  return Of(share, Kind::kSteps).error.rms >
         1.05 * Of(share, Kind::kSweeps).most_rms + reference.spread.rms;
}

SceneStates MeasureStates(const cli::SceneChoice& scene, const StatesOptions& options,
                          const std::function<void(const std::string&)>& show) {
  SceneStates result{.scene = scene, .states = {}, .empty = 0};
  const cli::SamplePlan plan(options.samples, options.frames);
  StateRun run(scene, options.advance);
  StateMeter meter(options);
  bench::ContactFrame before;
  while (run.frame() < options.frames) {
    const int frame = run.frame();
    show(fmt::format("{}: frame {} of {}{}", scene.info->name, frame, options.frames,
                     plan.IsSample(frame) ? ", measuring" : ""));
    if (plan.IsWarmUp(frame)) {
      before = run.Record();
    } else if (plan.IsSample(frame)) {
      BulletTrial recorder;
      run.StepAfter([&](bench::Substep* substep, const btContactSolverInfo& info) {
        const bench::ContactFrame rows = recorder.Rows(*substep, info);
        if (rows.rows.empty()) {
          ++result.empty;
          return;
        }
        result.states.push_back(meter.Measure(substep, info, before, rows));
        result.states.back().frame = frame;
      });
    } else {
      run.Step();
    }
  }
  return result;
}

}  // namespace cairn::accuracy
