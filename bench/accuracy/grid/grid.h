// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "accuracy/grid/grid_world.h"
#include "cairn/settings.h"

namespace cairn::accuracy {

struct GridOptions {
  int frames = 240;
  int iterations = 10;
  StepPolicy policy = StepPolicy::kMeasured;
};

enum class GridSolver { kSteps, kSweeps, kBullet };
inline constexpr std::array kGridSolvers = {GridSolver::kSteps, GridSolver::kSweeps,
                                            GridSolver::kBullet};
/// "steps", "sweeps", "Bullet"
std::string_view NameOf(GridSolver solver);

/// What became of a cell.
struct GridRun {
  bool not_a_number = false;
  std::string failure;             ///< NaN, or an explosion; empty if there was none.
  int failed_in = -1;              ///< Frame.
  double energy_gain = 0;          ///< Most above the start, over GridWorld::EnergyScale(); >= 0.
  double defect = 0;               ///< Mean over the second half [m]; infinity from a failed run.
  int accepted = 0, restored = 0;  ///< Subspace steps.
};

struct GridResult {
  Cell cell;
  std::array<GridRun, kGridSolvers.size()> runs;

  const GridRun& Of(GridSolver solver) const { return runs[static_cast<size_t>(solver)]; }
  /// Steps gain more energy than Bullet does, by more than 1 % of the scale and of Bullet's gain.
  bool GainsEnergy() const;
  /// The defect with steps is larger than with sweeps alone, by more than a quarter and 1 mm.
  bool Worse() const;
  /// The other way round.
  bool Better() const;
};

/// With any of Bullet's solvers. @param after_step  is called after each, may be empty
GridRun RunCell(const Cell& cell, btConstraintSolver* solver, const GridOptions& options,
                const std::function<void(GridRun*)>& after_step);
GridRun RunCell(const Cell& cell, GridSolver solver, const GridOptions& options);
/// With all of kGridSolvers.
GridResult RunCell(const Cell& cell, const GridOptions& options);

/// Names each cell in which Cairn produced NaN, one sentence each; empty if there is none.
std::vector<std::string> NotNumbers(const std::vector<GridResult>& results);

/// How to read it, a table of sums, and one of the cells that stand out.
void PrintGrid(const std::vector<GridResult>& results, const GridOptions& options);

nlohmann::ordered_json ToJson(const std::vector<GridResult>& results, const GridOptions& options);

}  // namespace cairn::accuracy
