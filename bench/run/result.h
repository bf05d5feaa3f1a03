// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "animation/animation.h"
#include "contestants/timeline.h"
#include "effort/effort_ladder.h"
#include "effort/scaling.h"
#include "run/frame_facts.h"
#include "support/machine/metronome.h"
#include "support/machine/run_context.h"
#include "support/machine/setup.h"
#include "support/statistics.h"

namespace cairn::cli {

/// The version of what `cairn run --json` writes, and of what `cairn compare` reads.
inline constexpr int kRunSchema = 1;

/// One frame of one solver.
struct Frame {
  double time = 0;  ///< In the solver, observing not counted [ms].
  int iterations = 0;
  double residual = kNotMeasured;  ///< Largest of all groups, on observed frames [m/s].
  int steps_accepted = 0, steps_restored = 0, factorisations = 0;
  int guarded = 0;            ///< Islands on which something was guarded; see cairn::Guards.
  int rows = 0, islands = 0;  ///< Given to the solver, on observed frames; 0 otherwise.
  FrameFacts facts;           ///< With RunOptions::page.
};

/// A physical fact of a scene after the last frame.
struct Fact {
  std::string name, unit;
  double value = kNotMeasured;
};

struct SolverFailure {
  int frame = 0;
  std::string reason;
};

/// One solver on one scene.
struct SolverResult {
  std::string label;
  bool counts_iterations = true;             ///< False for a direct solver.
  bool is_ours = false;                      ///< A solver of Cairn.
  std::string effort;                        ///< "10 iterations", "2 ms": what it was told.
  std::vector<Frame> frames;                 ///< Of the first repetition, as all that follows.
  std::vector<std::vector<Frame>> repeated;  ///< Frames of the further repetitions.
  /// For each sample [m/s]; NaN where the solver refused the state.
  std::vector<double> velocity_errors;
  std::optional<double> fallback_share;  ///< Calls it left to another solver, in [0, 1].
  /// Of the first repetition that failed: its world was not stepped after this frame.
  std::optional<SolverFailure> failure;
  std::vector<Fact> facts;
  std::optional<bool> standing;  ///< Only where the scene is something that can fall.
  /// For each sample, from the least effort on; with RunOptions::page.
  std::vector<std::vector<CurvePoint>> curves;
  Animation animation;  ///< With RunOptions::page.
  Timeline timeline;    ///< Of one frame, with RunOptions::timelines.
};

/// A state that every solver was given.
struct Sample {
  int frame = 0;
  std::string source;             ///< Label of the solver in whose run it occurred.
  double reference_residual = 0;  ///< What the converged reference left [m/s].
};

struct SceneResult {
  std::string name, description;
  int size = 0;
  std::uint64_t seed = 0;
  int friction_directions = 2;  ///< At each contact, as asked for.
  int bodies = 0, joints = 0;
  double mass_ratio = kNotMeasured;  ///< Of the heaviest body and the lightest.
  int observed_every = 1;            ///< The residual was measured in every k-th frame.
  int warmup = 0;                    ///< The first frames, which do not count.
  /// Of each repetition: the metronome after each frame.
  std::vector<std::vector<Metronome::Beat>> beats;
  bool bullet_has_zones = true;  ///< Bullet's profiler calls its hooks, as far as is known.
  std::vector<Sample> samples;
  std::vector<SolverResult> solvers;
  /// Of the last frame of the first solver of Cairn; with RunOptions::page.
  std::optional<Scaling> scaling;
};

/// Everything a run knows, for every form of output.
struct RunResult : RunContext {
  std::optional<std::chrono::nanoseconds> budget;
  int frames = 0;  ///< asked for
  int warmup = 0;  ///< of these
  int repeat = 1;
  Setup setup;
  bool show_noise = false;
  std::vector<SceneResult> scenes;
  std::optional<std::int64_t> units;  ///< Of work, instead of a budget of time.

  /// A solver of Cairn failed.
  bool check_failed() const;
};

}  // namespace cairn::cli
