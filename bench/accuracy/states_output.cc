// SPDX-License-Identifier: MIT
#include "accuracy/states_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "accuracy/goals.h"
#include "accuracy/report.h"
#include "cli/statistics.h"
#include "frames/markdown.h"

namespace cairn::accuracy {
namespace {

using frames::MarkdownTable;
using States = std::vector<StateResult>;

/// Spread of the reference over an error that can be told from it.
constexpr double kMostSpread = 0.1;

/// The median over states of a figure.
template <class Figure>
double MedianOf(const States& states, Figure figure) {
  std::vector<double> values;
  for (const StateResult& state : states) values.push_back(figure(state));
  return cli::Median(values);
}

template <class Figure>
double LargestOf(const States& states, Figure figure) {
  std::vector<double> values;
  for (const StateResult& state : states) values.push_back(figure(state));
  return cli::Largest(values);
}

std::string Worth(const States& states, Share share, Kind kind) {
  const double median = MedianOf(states, [&](const StateResult& state) {
    return state.Of(share, kind).worth ? *state.Of(share, kind).worth : kInfinity;
  });
  if (std::isfinite(median)) return fmt::format("{:.0f}", median);
  const double followed =
      MedianOf(states, [](const StateResult& state) { return double(state.followed); });
  return fmt::format("> {:.0f}", followed);
}

std::string Verdict(double ratio, double goal) {
  if (std::isnan(goal)) return "-";
  return ratio <= goal ? "met" : "missed";
}

void AddErrors(const SceneStates& scene, Share share, MarkdownTable* table) {
  const States& states = scene.states;
  const auto error = [&](Kind kind) {
    return [share, kind](const StateResult& s) { return s.Of(share, kind).error; };
  };
  const auto rms = [](auto get) { return [get](const StateResult& s) { return get(s).rms; }; };
  const auto bullet = [](const StateResult& s) { return s.bullet_error; };
  const auto sweeps = error(Kind::kSweeps), steps = error(Kind::kSteps);
  const auto ratio = [&](auto above, auto below) {
    return MedianOf(states, [&](const StateResult& s) { return above(s).rms / below(s).rms; });
  };
  const double goal = GoalOf(scene.scene.info->name), reached = ratio(steps, bullet);
  const auto worse = std::count_if(states.begin(), states.end(),
                                   [&](const StateResult& s) { return s.WorseThanSweeps(share); });
  const auto of_steps = [&](double CairnResult::*figure) {
    return MedianOf(states,
                    [&](const StateResult& s) { return s.Of(share, Kind::kSteps).*figure; });
  };
  const auto stepped = std::count_if(states.begin(), states.end(), [&](const StateResult& s) {
    return s.Of(share, Kind::kSteps).accepted > 0;
  });
  table->Add(
      {std::string(scene.scene.info->name), Digits(MedianOf(states, rms(bullet))),
       Digits(MedianOf(states, rms(sweeps))), Digits(MedianOf(states, rms(steps))),
       Digits(ratio(sweeps, bullet)), Digits(reached), Digits(goal), Verdict(reached, goal),
       Digits(MedianOf(states,
                       [&](const StateResult& s) { return steps(s).max / s.bullet_error.max; })),
       Worth(states, share, Kind::kSweeps), Worth(states, share, Kind::kSteps),
       Digits(MedianOf(states,
                       [&](const StateResult& s) { return s.Of(share, Kind::kSweeps).sweeps; })),
       Digits(of_steps(&CairnResult::sweeps)), Digits(of_steps(&CairnResult::factorisations)),
       Digits(of_steps(&CairnResult::accepted)), Digits(of_steps(&CairnResult::restored)),
       fmt::format("{}/{}", stepped, states.size()), fmt::format("{}/{}", worse, states.size())});
}

void PrintErrors(std::span<const SceneStates> scenes, Share share) {
  MarkdownTable table({"scene", "Bullet", "sweeps", "steps", "sweeps/Bullet", "steps/Bullet",
                       "goal", "", "of max", "sweeps worth", "steps worth", "sweeps made",
                       "with steps", "factorised", "accepted", "restored", "stepped", "worse"});
  for (const SceneStates& scene : scenes) {
    if (!scene.states.empty()) AddErrors(scene, share, &table);
  }
  fmt::print("\n## Errors in {}\n\n", share == Share::kWhole
                                          ? "the time of Bullet's whole solver"
                                          : "the time of Bullet's iterations alone");
  table.Print();
}

void PrintTimes(std::span<const SceneStates> scenes) {
  MarkdownTable table({"scene", "bodies", "rows", "states", "Bullet ms", "set-up", "iterations",
                       "split", "finish", "Cairn floor ms", "steps/whole", "steps/iterations",
                       "interrupted", "reference max", "spread", "converged"});
  for (const SceneStates& scene : scenes) {
    const States& states = scene.states;
    if (states.empty()) continue;
    const auto share_of = [&](double BulletTime::*part) {
      return fmt::format("{:.0f} %", 100 * MedianOf(states, [&](const StateResult& s) {
                                       return s.bullet_time.*part / s.bullet_time.total();
                                     }));
    };
    const auto kept = [&](Share share) {
      return fmt::format("{:.2f}", MedianOf(states, [&](const StateResult& s) {
                           return s.Of(share, Kind::kSteps).cpu / s.Budget(share);
                         }));
    };
    const double interrupted = LargestOf(states, [](const StateResult& s) {
      int count = 0;
      for (const auto& of_share : s.cairn) {
        for (const CairnResult& cairn : of_share) count += cairn.preempted;
      }
      return count;
    });
    const auto converged = std::count_if(states.begin(), states.end(),
                                         [](const StateResult& s) { return s.reference.reached; });
    table.Add(
        {std::string(scene.scene.info->name),
         Digits(MedianOf(states, [](const StateResult& s) { return s.bodies; })),
         fmt::format("{:.0f}", MedianOf(states, [](const StateResult& s) { return s.rows; })),
         fmt::format("{}", states.size()),
         Digits(MedianOf(states, [](const StateResult& s) { return s.bullet_time.total(); })),
         share_of(&BulletTime::set_up), share_of(&BulletTime::iterations),
         share_of(&BulletTime::split), share_of(&BulletTime::finish),
         Digits(MedianOf(states, [](const StateResult& s) { return s.floor; })),
         kept(Share::kWhole), kept(Share::kIterations), fmt::format("{:.0f}", interrupted),
         Digits(LargestOf(states, [](const StateResult& s) { return s.reference.residual_max; })),
         Digits(MedianOf(states, [](const StateResult& s) { return s.reference.spread.rms; })),
         fmt::format("{}/{}", converged, states.size())});
  }
  fmt::print("\n## What was compared\n\n");
  table.Print();
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
        scene.scene.info->name, not_reached, scene.states.size(), kConvergedTo, Digits(residual),
        100 * share, share > kMostSpread ? ": too much to tell solvers apart" : "");
  }
  if (scene.empty > 0) {
    fmt::print("- {}: nothing touches in {} samples\n", scene.scene.info->name, scene.empty);
  }
}

}  // namespace

void PrintStates(std::span<const SceneStates> scenes, const StatesOptions& options) {
  fmt::print(
      "- states: {} of {} frames of each scene, which Bullet makes with {} iterations; every "
      "solver "
      "starts each with the same warm start\n"
      "- error: of velocities against the converged reference, root mean square by mass and "
      "inertia "
      "[m/s]; medians over states, and of\n  ratios; 'of max': ratio steps/Bullet of the largest "
      "error of a body\n"
      "- Bullet: {} iterations; its time (CPU, median of {} rounds) is Cairn's Budget::Time, in "
      "Solve() on the recorded rows: Cairn makes\n  no rows there, so the whole time flatters it, "
      "and the time of the iterations alone has to pay for its own reading and writing\n"
      "- worth: iterations of Bullet until its error is no larger; factorised, accepted, restored: "
      "per Solve(); stepped: states with\n  a step accepted; worse: states in which steps are "
      "worse than sweeps alone by more than noise\n",
      options.samples, options.frames, options.advance, options.iterations, options.rounds);
  for (const Share share : kShares) PrintErrors(scenes, share);
  PrintTimes(scenes);
  fmt::print(
      "- floor: CPU time of a Solve() without sweeps; steps/whole, steps/iterations: CPU time that "
      "Cairn took, over its budget\n"
      "- interrupted: rounds of one state that never ran undisturbed; reference max: worst "
      "residual "
      "of the reference [m/s]; spread: rms to\n  the reference from a cold start [m/s]; converged: "
      "states whose reference has a residual of at most {:g} m/s\n",
      kConvergedTo);
  for (const SceneStates& scene : scenes) PrintDoubts(scene);
}

}  // namespace cairn::accuracy
