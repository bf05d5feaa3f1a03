// SPDX-License-Identifier: MIT
#include "accuracy/grid/grid.h"

#include <cairn/bullet/constraint_solver.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "cairn/contact_problem.h"
#include "contestants/watched_solver.h"
#include "support/statistics.h"

namespace cairn::accuracy {
namespace {

constexpr double kRoom = 1e-3;    ///< Differences of defects that do not count [m].
constexpr double kFactor = 1.25;  ///< Likewise.
constexpr double kEnergy = 0.01;  ///< Of the scale, and of Bullet's gain.

bool IsMuchLarger(double a, double b) { return a > kFactor * b + kRoom; }

Settings SettingsOf(GridSolver solver, const GridOptions& options) {
  Settings settings;
  settings.step_policy = options.policy;
  if (solver == GridSolver::kSweeps) settings.k_sm = 0;
  return settings;
}

}  // namespace

std::string_view NameOf(GridSolver solver) {
  switch (solver) {
    case GridSolver::kSteps:
      return "steps";
    case GridSolver::kSweeps:
      return "sweeps";
    case GridSolver::kBullet:
      break;
  }
  return "Bullet";
}

bool GridResult::GainsEnergy() const {
  return Of(GridSolver::kSteps).energy_gain >
         (1 + kEnergy) * Of(GridSolver::kBullet).energy_gain + kEnergy;
}

bool GridResult::Worse() const {
  return IsMuchLarger(Of(GridSolver::kSteps).defect, Of(GridSolver::kSweeps).defect);
}

bool GridResult::Better() const {
  return IsMuchLarger(Of(GridSolver::kSweeps).defect, Of(GridSolver::kSteps).defect);
}

GridRun RunCell(const Cell& cell, btConstraintSolver* solver, const GridOptions& options,
                const std::function<void(GridRun*)>& after_step) {
  cli::WatchedSolver watched(solver);
  GridWorld world(cell, &watched);
  watched.Watch(world.world().bullet());
  world.world().solver_info().m_numIterations = options.iterations;
  GridRun run;
  const double start = world.Energy(), scale = world.EnergyScale();
  std::vector<double> defects;
  for (int frame = 0; frame < options.frames; ++frame) {
    world.Step();
    if (after_step) after_step(&run);
    if (!watched.failure().empty()) {
      run.not_a_number = watched.not_a_number();
      run.failure = watched.failure();
      run.failed_in = frame;
      run.energy_gain = run.defect = kInfinity;
      return run;
    }
    run.energy_gain = std::max(run.energy_gain, (world.Energy() - start) / scale);
    if (frame >= options.frames / 2) defects.push_back(world.Defect());
  }
  run.defect = cli::Mean(defects);
  return run;
}

GridRun RunCell(const Cell& cell, GridSolver solver, const GridOptions& options) {
  if (solver == GridSolver::kBullet) {
    btSequentialImpulseConstraintSolver bullet;
    return RunCell(cell, &bullet, options, {});
  }
  bullet::ConstraintSolver cairn(SettingsOf(solver, options));
  return RunCell(cell, &cairn, options, [&cairn](GridRun* run) {
    run->accepted += cairn.report().steps_accepted;
    run->restored += cairn.report().steps_restored;
  });
}

GridResult RunCell(const Cell& cell, const GridOptions& options) {
  GridResult result{.cell = cell, .runs = {}};
  for (const GridSolver solver : kGridSolvers) {
    result.runs[static_cast<size_t>(solver)] = RunCell(cell, solver, options);
  }
  return result;
}

std::vector<std::string> NotNumbers(const std::vector<GridResult>& results) {
  std::vector<std::string> sentences;
  for (const GridResult& result : results) {
    for (const GridSolver solver : {GridSolver::kSteps, GridSolver::kSweeps}) {
      const GridRun& run = result.Of(solver);
      if (!run.not_a_number) continue;
      sentences.push_back(fmt::format("{} in frame {} of a {}, Cairn with {}", run.failure,
                                      run.failed_in, NameOf(result.cell), NameOf(solver)));
    }
  }
  return sentences;
}

}  // namespace cairn::accuracy
