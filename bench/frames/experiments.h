// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cairn/settings.h"
#include "run/scene_choice.h"

namespace cairn::frames {

using cli::SceneChoice;

/// Frames in a row.
struct WindowOptions {
  std::vector<SceneChoice> scenes;
  int frame = 60;   ///< The first that is looked at.
  int frames = 60;  ///< So many.
};
/// What Cairn does in a substep of Bullet's ten iterations.
enum class Work {
  kPlainSweeps,  ///< Ten, and no subspace step.
  kDefault,      ///< What Settings{} ask for.
};
struct ThreadOptions {
  WindowOptions window;
  Work work = Work::kPlainSweeps;
  std::vector<int> threads = {1, 2};
  int gaps = 0;        ///< PrintScaling() alone: so many stretches between stages.
  bool parts = false;  ///< PrintThreads() alone: also what threads are busy with.
};
/// Wall time of substeps on so many threads each, in worlds that Cairn drives: reading, solving,
/// writing back, and the whole step of the world.
void PrintThreads(const ThreadOptions& options, const std::string& command);

/// What substeps would take on more threads than there are cores: from spans of one thread that
/// does what is cut for so many.
void PrintScaling(const ThreadOptions& options, const std::string& command);

/// Whole steps of btDiscreteDynamicsWorldMt with Bullet's solvers and with Cairn.
/// @throws std::runtime_error in a Bullet that does not lock
void PrintMtWorlds(const ThreadOptions& options, const std::string& command);

/// Whole steps of two worlds, one with Bullet's stock solver and one with Cairn in its place, ten
/// iterations each, one thread, stepped in turn: what they take, and what of it is spent outside of
/// the solver, which no solver can make faster.
void PrintSteps(const WindowOptions& options, Work work, const std::string& command);

/// Bullet's stock solver against Cairn in its place, on the very same substeps of worlds that
/// Bullet drives: ten sweeps, no subspace step, one thread, from prepareSolve() to the end of
/// allSolved().
void PrintSwaps(const WindowOptions& options, const std::string& command);

enum class Steps { kWherePredicted, kNone };
/// Where a substep of Cairn goes, in worlds that it drives itself, one thread: with what it works
/// on in the caches, and with caches emptied before.
void PrintParts(const WindowOptions& options, Steps steps, const std::string& command);

/// How much code a substep runs through, with Bullet's stock solver and with Cairn: what caches
/// have to fetch where a game has done other things since the last one.
/// @param functions  also so many functions of each, those of the most lines
/// @throws std::runtime_error where processes cannot be stepped
void PrintFootprints(const WindowOptions& options, int functions, const std::string& command);

/// What budgets are measured with.
enum class BudgetClock {
  kWall,
  kThreadCpu,  ///< As on a machine with nothing else to do.
};

struct DeadlineOptions {
  std::vector<SceneChoice> scenes;
  int worlds = 200;  ///< Random worlds of seeds from first_seed on, all in one row.
  std::uint64_t first_seed = 0;
  std::vector<double> budgets_ms = {0.25, 0.5, 1, 2, 4, 8, 16};
  int warm_up = 30;    ///< Frames of each world that do not count.
  int frames = 240;    ///< Of a scene, after those.
  double seconds = 3;  ///< Of a random world, with those.
  int worst = 0;       ///< Substeps of each row of the table that are shown one by one.
  BudgetClock clock = BudgetClock::kWall;
  Settings settings;  ///< All but the budget and its clock.
};

/// By how much the adapter exceeds Budget::Time in worlds that it drives, CPU time and wall clock.
void PrintDeadlines(const DeadlineOptions& options, const std::string& command);

/// "pyramid 100"; without a size that is the default.
std::string NameOf(const SceneChoice& scene);

/// Plain sweeps, as many as asked: nothing else ends a Solve().
Settings Sweeps(int count, int threads);
/// What Bullet's ten iterations are for that.
Settings SettingsFor(Work work, int threads);
/// "ten plain sweeps"
std::string Describe(Work work);

}  // namespace cairn::frames
