// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "contestants/solver_registry.h"
#include "run/result.h"
#include "run/scene_choice.h"
#include "support/machine/run_context.h"
#include "support/machine/setup.h"
#include "support/progress.h"
#include "support/text_table.h"

namespace cairn::cli {

/// What `cairn run small` was asked for, checked.
struct SmallOptions {
  std::vector<SceneChoice> worlds;
  bool random = false;  ///< These are random worlds, of which there may be hundreds.
  int slowest = 10;     ///< Of random worlds, so many are shown one by one.
  int frames = 220;
  int warmup = 20;   ///< The first frames, which are run but do not count.
  int samples = 8;   ///< States on which velocity errors are measured.
  bool cold = true;  ///< With caches emptied, too.
  Setup setup;
  ProgressMode progress = ProgressMode::kAuto;
};

/// One solver in one world.
struct SmallSolver {
  double hot = kNotMeasured, cold = kNotMeasured;  ///< Of a substep, median [us].
  std::vector<double> errors;  ///< On each sampled state [m/s]; infinite where it blew up.
  /// Of the first of its runs that failed; its times count for nothing.
  std::optional<SolverFailure> failure;
};

/// All solvers in one world; in the order of SmallSolvers().
struct SmallResult {
  std::string name;  ///< Of the scene; of a random world its kind.
  int size = 0;      ///< Of a random world its seed.
  int bodies = 0, joints = 0;
  double points = kNotMeasured;  ///< Of contact, as in Bullet's run, median.
  std::vector<SmallSolver> solvers;
  std::vector<double> reference_residuals;  ///< What the converged reference left [m/s].
};

/// Bullet as it comes, Cairn's sweeps alone, Cairn as it comes: the first is what the others are
/// compared with.
std::span<const SolverChoice> SmallSolvers();

/// Errors below this do not tell solvers apart [m/s]: nobody sees them, and floats hardly do.
inline constexpr double kLeastError = 1e-5;

/// Times and errors of a solver as shares of those of the first one; NaN where it has none. Of
/// errors the median over the states on which the first one's is at least kLeastError.
double HotRatio(const SmallResult& world, size_t solver);
double ColdRatio(const SmallResult& world, size_t solver);
double ErrorRatio(const SmallResult& world, size_t solver);

/// A solver of Cairn failed in one of the worlds.
bool AnyCairnFailed(std::span<const SmallResult> worlds);

/// Worlds as most games have them, of 1 to 400 bodies, in the order of the table: the scenes that
/// `cairn run small` runs, at sizes of its own. A new one is a scene, and one line here.
std::vector<SceneChoice> SmallWorlds();

/// Those of the words typed, in their order: a name of SmallWorlds() at its size there, any other
/// scene as ParseScene() reads it. All of SmallWorlds() without words. @throws Failure (kUsage)
std::vector<SceneChoice> ParseSmallWorlds(std::span<const std::string> words);

/// Random worlds of `cairn worlds`. @pre seeds fit an int
std::vector<SceneChoice> RandomWorlds(std::span<const std::uint64_t> seeds);

/// Each solver in worlds of its own, stepped in turn: once with nothing but each other beside them,
/// once with caches emptied before each step. Then errors, see SameStates.
std::vector<SmallResult> RunSmall(const SmallOptions& options);

/// A line for each world, and geometric means.
TextTable SmallTable(std::span<const SmallResult> worlds);

/// Of random worlds: a line for each kind with medians and geometric means, ...
TextTable KindsTable(std::span<const SmallResult> worlds);
/// ... how many are how much faster or slower than with Bullet, ...
TextTable SharesTable(std::span<const SmallResult> worlds);
/// ... and those in which Cairn as it comes takes longest beside Bullet, hot, as in SmallTable().
TextTable SlowestTable(std::span<const SmallResult> worlds, int count);

/// What the columns are, and where it was measured.
std::string SmallReadingHelp(const SmallOptions& options, const RunContext& context);

std::string SmallToJson(const SmallOptions& options, std::span<const SmallResult> worlds,
                        const RunContext& context);

}  // namespace cairn::cli
