// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "accuracy/tension/tension_world.h"

namespace cairn::accuracy {

/// A solver with its settings, made anew for each cell.
struct TensionSolver {
  std::string name, description;
  std::function<std::unique_ptr<btConstraintSolver>()> make;
  int iterations = 10;
};

/// Cairn as it comes and with less, and Bullet.
std::span<const TensionSolver> TensionSolvers();
/// Names with commas between them, or all. @throws cli::Failure for a name that there is not.
std::vector<TensionSolver> ParseTensionSolvers(const std::string& names);

struct TensionOptions {
  double seconds = 10;
  /// Steps in a second of the run that others are compared with.
  static constexpr double kReferenceRate = 3840;
  /// Looks at a chain in a second, the same for every rate that it divides.
  static constexpr double kLooks = 30;
  /// Gaps from which a chain counts as torn [m].
  static constexpr double kTorn = 0.1;
};

/// What became of a cell.
struct TensionRun {
  std::string failure;     ///< NaN, or an explosion; empty if there was none.
  double gap = 0;          ///< Largest of the run [m].
  double energy_gain = 0;  ///< Most above the start, over the scale.
  double energy_loss = 0;  ///< At the end, below the start, over the scale.
  double spin_change = 0;  ///< Largest, of angular momentum over that at the start; NaN: no law.
  double steps_taken = 0;  ///< Subspace steps kept, in a step of the world.
  double cpu_us = 0;       ///< Of a step, Bullet's collision detection included.
  std::vector<btVector3> load;    ///< At each look [m].
  std::vector<double> crossings;  ///< When the load passed below the pin [s]; in a plane.

  bool torn() const { return !failure.empty() || !(gap < TensionOptions::kTorn); }
};

/// How a run differs from one at kReferenceRate. NaN: there is nothing to compare.
struct TensionDifference {
  double period = 0;  ///< Of the last time that both passed below the pin, relative.
  double load = 0;    ///< Largest distance of the load, over the length of the chain.
};

struct TensionResult {
  TensionCell cell;
  std::vector<TensionRun> runs;                ///< One per solver.
  std::vector<TensionDifference> differences;  ///< Likewise; empty without a reference.
};

TensionRun RunCell(const TensionCell& cell, const TensionSolver& solver,
                   const TensionOptions& options);
/// The same chain at kReferenceRate, where no stiffness is needed.
TensionRun RunReference(const TensionCell& cell, const TensionOptions& options);
TensionDifference Compare(const TensionRun& run, const TensionRun& reference, double length);

/// How to read it, tables of gaps, and one of everything else.
void PrintTension(const std::vector<TensionResult>& results, std::span<const TensionSolver> solvers,
                  const TensionOptions& options);

nlohmann::ordered_json ToJson(const std::vector<TensionResult>& results,
                              std::span<const TensionSolver> solvers,
                              const TensionOptions& options);

}  // namespace cairn::accuracy
