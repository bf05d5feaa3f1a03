// SPDX-License-Identifier: MIT
#include "accuracy/states/states.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "accuracy/command.h"
#include "support/statistics.h"
#include "support/text_table.h"

namespace cairn::accuracy {
namespace {

using States = std::vector<StateResult>;

/// Spread of the reference over an error that can be told from it.
constexpr double kMostSpread = 0.1;

/// A figure of each state.
template <class Figure>
std::vector<double> Of(const States& states, Figure figure) {
  std::vector<double> values;
  for (const StateResult& state : states) values.push_back(static_cast<double>(figure(state)));
  return values;
}

template <class Figure>
double MedianOf(const States& states, Figure figure) {
  return cli::Median(Of(states, figure));
}

template <class Figure>
double LargestOf(const States& states, Figure figure) {
  return cli::Largest(Of(states, figure));
}

/// "0.12 (0.05..0.3)": median, smallest and largest.
template <class Figure>
std::string Range(const States& states, Figure figure) {
  const std::vector<double> values = Of(states, figure);
  return fmt::format("{} ({}..{})", Digits(cli::Median(values)), Digits(cli::Quantile(values, 0)),
                     Digits(cli::Largest(values)));
}

double Rms(const StateResult& state, Kind kind) { return state.Of(kind).error.rms; }

double ToBullet(const StateResult& state, Kind kind) {
  return Rms(state, kind) / state.bullet_error.rms;
}

std::string Worth(const States& states, Kind kind) {
  const double median = MedianOf(states, [&](const StateResult& state) {
    return state.Of(kind).worth ? *state.Of(kind).worth : kInfinity;
  });
  if (std::isfinite(median)) return fmt::format("{:.0f}", median);
  return fmt::format("> {:.0f}", MedianOf(states, [](const StateResult& s) { return s.followed; }));
}

std::string Verdict(double ratio, double goal) {
  if (std::isnan(goal)) return "-";
  return ratio <= goal ? "met" : "missed";
}

template <class Is>
std::string Count(const States& states, Is is) {
  return fmt::format("{}/{}", std::count_if(states.begin(), states.end(), is), states.size());
}

std::string Percent(double share) {
  return std::isnan(share) ? "-" : fmt::format("{:.0f} %", 100 * share);
}

void PrintErrors(std::span<const SceneStates> scenes) {
  cli::TextTable table = cli::TableOf(
      {"scene", "Bullet", "sweeps", "accelerated", "steps", "sweeps/Bullet", "accelerated/Bullet",
       "steps/Bullet", "goal", "", "of max", "worse than sweeps", "worse than accelerated"});
  for (const SceneStates& scene : scenes) {
    const States& states = scene.states;
    if (states.empty()) continue;
    const auto ratio = [](Kind kind) {
      return [kind](const StateResult& s) { return ToBullet(s, kind); };
    };
    const auto rms = [&](Kind kind) {
      return Digits(MedianOf(states, [kind](const StateResult& s) { return Rms(s, kind); }));
    };
    const auto worse = [&](Kind than) {
      return Count(states, [than](const StateResult& s) { return s.StepsAreWorseThan(than); });
    };
    const double goal = GoalOf(scene.scene.info->name);
    const double reached = MedianOf(states, ratio(Kind::kSteps));
    table.rows.push_back(
        {std::string(scene.scene.info->name),
         Digits(MedianOf(states, [](const StateResult& s) { return s.bullet_error.rms; })),
         rms(Kind::kSweeps), rms(Kind::kAccelerated), rms(Kind::kSteps),
         Range(states, ratio(Kind::kSweeps)), Range(states, ratio(Kind::kAccelerated)),
         Range(states, ratio(Kind::kSteps)), Digits(goal), Verdict(reached, goal),
         Digits(MedianOf(states,
                         [](const StateResult& s) {
                           return s.Of(Kind::kSteps).error.max / s.bullet_error.max;
                         })),
         worse(Kind::kSweeps), worse(Kind::kAccelerated)});
  }
  fmt::print("\n## Errors in the time of Bullet's solver\n\n");
  fmt::print("{}\n", table.ToMarkdown());
}

void PrintWork(std::span<const SceneStates> scenes) {
  cli::TextTable table = cli::TableOf({"scene", "sweeps worth", "accelerated worth", "steps worth",
                                       "sweeps made", "accelerated", "with steps"});
  for (const SceneStates& scene : scenes) {
    const States& states = scene.states;
    if (states.empty()) continue;
    const auto made = [&](Kind kind) {
      return Range(states, [kind](const StateResult& s) { return s.Of(kind).frame.sweeps; });
    };
    table.rows.push_back({std::string(scene.scene.info->name), Worth(states, Kind::kSweeps),
                          Worth(states, Kind::kAccelerated), Worth(states, Kind::kSteps),
                          made(Kind::kSweeps), made(Kind::kAccelerated), made(Kind::kSteps)});
  }
  fmt::print("\n## What was done in that time\n\n");
  fmt::print("{}\n", table.ToMarkdown());
  fmt::print("- worth: iterations of Bullet until its error is no larger; made: sweeps\n");
}

std::string Spread(const Tail& tail) {
  return fmt::format("{:.0f} / {:.0f} / {:.0f}", tail.p50, tail.p99, tail.max);
}

void PrintFrames(std::span<const SceneStates> scenes) {
  cli::TextTable table =
      cli::TableOf({"scene", "frames", "stepped", "restored", "factorised", "CPU over us",
                    "wall over us", "wall over us, calm", "interrupted", "prediction p50", "p99"});
  for (const SceneStates& scene : scenes) {
    const FrameStatistics frames = StatisticsOf(scene.frames);
    if (frames.frames == 0) continue;
    table.rows.push_back({std::string(scene.scene.info->name), fmt::format("{}", frames.frames),
                          Percent(frames.stepped), Percent(frames.restored),
                          Digits(frames.factorisations), Spread(frames.cpu_over),
                          Spread(frames.wall_over), Spread(frames.wall_over_calm),
                          fmt::format("{}", frames.interrupted), Percent(frames.step_error.p50),
                          Percent(frames.step_error.p99)});
  }
  fmt::print("\n## All frames, with steps\n\n");
  fmt::print("{}\n", table.ToMarkdown());
  fmt::print(
      "- stepped: frames in which a subspace step ran; restored: of all steps, those undone; "
      "factorised: per frame\n"
      "- over: time above the budget in us, p50 / p99 / max, negative inside it; calm: of frames "
      "that were not interrupted\n"
      "- prediction: |time / predicted time - 1| of the steps of a frame, of frames that were not "
      "interrupted\n");
}

void PrintTimes(std::span<const SceneStates> scenes) {
  cli::TextTable table =
      cli::TableOf({"scene", "bodies", "rows", "states", "Bullet ms", "set-up", "iterations",
                    "split", "finish", "Cairn's set-up ms", "its write-back ms", "interrupted",
                    "reference max", "spread", "converged"});
  for (const SceneStates& scene : scenes) {
    const States& states = scene.states;
    if (states.empty()) continue;
    const auto share_of = [&](double BulletTime::*part) {
      return Percent(MedianOf(states, [&](const StateResult& s) {
        return s.bullet_time.*part / s.bullet_time.total();
      }));
    };
    const auto own = [&](double ShadowFrame::*part) {
      return Digits(
          MedianOf(states, [&](const StateResult& s) { return s.Of(Kind::kSteps).frame.*part; }));
    };
    table.rows.push_back(
        {std::string(scene.scene.info->name),
         Digits(MedianOf(states, [](const StateResult& s) { return s.bodies; })),
         fmt::format("{:.0f}", MedianOf(states, [](const StateResult& s) { return s.rows; })),
         fmt::format("{}", states.size()),
         Digits(MedianOf(states, [](const StateResult& s) { return s.bullet_time.total(); })),
         share_of(&BulletTime::set_up), share_of(&BulletTime::iterations),
         share_of(&BulletTime::split), share_of(&BulletTime::finish), own(&ShadowFrame::build),
         own(&ShadowFrame::write),
         Count(states, [](const StateResult& s) { return s.Interrupted(); }),
         Digits(LargestOf(states, [](const StateResult& s) { return s.reference.residual_max; })),
         Digits(MedianOf(states, [](const StateResult& s) { return s.reference.spread.rms; })),
         Count(states, [](const StateResult& s) { return s.reference.reached; })});
  }
  fmt::print("\n## What was compared\n\n");
  fmt::print("{}\n", table.ToMarkdown());
}

/// Where the reference is not what it should be.
void PrintDoubts(const SceneStates& scene) {
  int not_reached = 0;
  double residual = 0, share = 0;
  for (const StateResult& state : scene.states) {
    if (state.reference.reached) continue;
    ++not_reached;
    residual = std::max(residual, state.reference.residual_max);
    share = std::max(share, state.reference.spread.rms / state.LeastError());
  }
  if (not_reached > 0) {
    fmt::print(
        "- {}: {} of {} references did not converge to {:g} m/s, worst residual {} m/s; their "
        "spread "
        "is {:.2g} % of the smallest error at most{}\n",
        scene.scene.info->name, not_reached, scene.states.size(), bench::kConvergedTo,
        Digits(residual), 100 * share,
        share > kMostSpread ? ": too much to tell solvers apart" : "");
  }
  if (scene.empty > 0) {
    fmt::print("- {}: nothing touches in {} samples\n", scene.scene.info->name, scene.empty);
  }
}

}  // namespace

void PrintStates(std::span<const SceneStates> scenes, const StatesOptions& options) {
  fmt::print(
      "- states: {} of {} frames of each scene, which Bullet makes with {} iterations. Every "
      "solver is a solver of the world there, from\n  contacts and joints to velocities, and "
      "starts from the contact impulses of the state; nothing that it does stays\n"
      "- Bullet: {} iterations; the CPU time of its whole solver (set-up, iterations, write-back; "
      "median of {} solves, between samples of\n  the last {} frames) is Cairn's Budget::Time, "
      "set-up and write-back included\n"
      "- Cairn: the adapter in Mode::kFast, with sweeps, with accelerated sweeps, and with steps; "
      "each solves every frame of the run once,\n  so that what a solver learns, and impulses of "
      "joints, come from the frames before as in a game\n"
      "- error: of velocities against the converged reference, root mean square by mass and "
      "inertia [m/s]; medians over states, and of\n  ratios with the smallest and the largest; 'of "
      "max': ratio steps/Bullet of the largest error of a body; worse: states in which steps\n  "
      "are worse by more than a twentieth and what solutions differ\n",
      options.samples, options.frames, options.advance, options.iterations, options.rounds,
      options.rounds);
  PrintErrors(scenes);
  PrintWork(scenes);
  PrintFrames(scenes);
  PrintTimes(scenes);
  fmt::print(
      "- interrupted: states in which a solve was taken off its core in all frames that were "
      "tried; "
      "reference max: worst residual of the\n  reference [m/s]; spread: rms to the reference from "
      "a "
      "cold start [m/s]; converged: states whose reference has a residual of at most {:g} m/s\n",
      bench::kConvergedTo);
  for (const SceneStates& scene : scenes) PrintDoubts(scene);
}

}  // namespace cairn::accuracy
