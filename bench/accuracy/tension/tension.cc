// SPDX-License-Identifier: MIT
#include "accuracy/tension/tension.h"

#include <cairn/bullet/constraint_solver.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "contestants/watched_solver.h"
#include "support/machine/stopwatch.h"
#include "support/statistics.h"

namespace cairn::accuracy {
namespace {

using cli::kNotMeasured;

TensionSolver Cairn(std::string name, std::string description, const Settings& settings,
                    const bullet::Options& options = {}, int iterations = 10) {
  return {std::move(name), std::move(description),
          [=] { return std::make_unique<bullet::ConstraintSolver>(settings, options); },
          iterations};
}

TensionSolver Bullet(std::string name, int iterations) {
  return {std::move(name), "Bullet with so many iterations",
          [] { return std::make_unique<btSequentialImpulseConstraintSolver>(); }, iterations};
}

double Norm(const std::array<double, 3>& v) { return std::hypot(v[0], v[1], v[2]); }

/// Takes down what is asked of a chain, step by step.
class Observer {
 public:
  Observer(const TensionCell& cell, const TensionWorld& world)
      : cell_(cell),
        world_(world),
        energy_(world.Energy()),
        spin_(world.Spin()),
        before_(world.Load()) {}

  /// After the step that ends at a time [s].
  void See(int step, TensionRun* run) {
    const double time = (step + 1) / cell_.rate, scale = world_.energy_scale();
    run->gap = std::max(run->gap, world_.Gap());
    const double energy = (world_.Energy() - energy_) / scale;
    run->energy_gain = std::max(run->energy_gain, energy);
    run->energy_loss = -energy;
    if (cell_.stage == Stage::kPlane) {
      run->spin_change = kNotMeasured;
    } else {
      std::array<double, 3> change = world_.Spin();
      for (int k = 0; k < 3; ++k) change[k] -= spin_[k];
      run->spin_change = std::max(run->spin_change, Norm(change) / Norm(spin_));
    }
    const btVector3 load = world_.Load();
    const double x = static_cast<double>(load.x()), x_before = static_cast<double>(before_.x());
    if (cell_.stage == Stage::kPlane && x * x_before < 0 && load.y() < 0) {
      run->crossings.push_back(time - x / (x - x_before) / cell_.rate);
    }
    before_ = load;
    // the same times at each rate
    const double looks = time * TensionOptions::kLooks;
    if (std::abs(looks - std::round(looks)) < 1e-6) run->load.push_back(load);
  }

 private:
  const TensionCell& cell_;
  const TensionWorld& world_;
  double energy_;
  std::array<double, 3> spin_;
  btVector3 before_;
};

}  // namespace

std::span<const TensionSolver> TensionSolvers() {
  const auto sweeps = [] {
    Settings settings;
    settings.k_sm = 0;
    return settings;
  };
  const auto parts = [](int substeps, int k_sm = 2, bool relax = false) {
    Settings settings;
    settings.relax = relax;
    settings.substeps = substeps;
    settings.k_sm = k_sm;
    return settings;
  };
  const auto always = [] {
    Settings settings;
    settings.step_policy = StepPolicy::kAlways;
    return settings;
  };
  static const TensionSolver solvers[] = {
      Cairn("cairn", "Cairn as it comes", {}),
      Cairn("cairn-plain", "without geometric stiffness", {}, {.geometric_stiffness = false}),
      Cairn("cairn-hard", "contacts that last stay hard", {}, {.resting_slop = false}),
      Cairn("cairn-cold", "joints and friction start from zero", {},
            {.warm_start_friction = false, .warm_start_joints = false}),
      Cairn("cairn-always", "a subspace step in every frame", always()),
      Cairn("cairn-2", "two substeps", parts(2)),
      Cairn("cairn-4", "four substeps", parts(4)),
      Cairn("cairn-4-plain", "the same without stiffness", parts(4),
            {.geometric_stiffness = false}),
      Cairn("cairn-4x3", "four substeps of three iterations: about the time of one", parts(4), {},
            3),
      Cairn("cairn-4-relax", "four substeps, errors taken back without velocity",
            parts(4, 2, true)),
      Cairn("cairn-40", "one step, as many iterations as four of 10", {}, {}, 40),
      Cairn("cairn-4-sweeps", "four substeps of sweeps only", parts(4, 0)),
      Cairn("cairn-sweeps", "k_sm = 0: sweeps only", sweeps()),
      Cairn("cairn-sweeps-plain", "the same without stiffness", sweeps(),
            {.geometric_stiffness = false}),
      Bullet("bullet-10", 10),
      Bullet("bullet-200", 200)};
  return solvers;
}

TensionRun RunCell(const TensionCell& cell, const TensionSolver& solver,
                   const TensionOptions& options) {
  const std::unique_ptr<btConstraintSolver> made = solver.make();
  cli::WatchedSolver watched(made.get());
  TensionWorld world(cell, &watched);
  watched.Watch(world.world().bullet());
  world.world().solver_info().m_numIterations = solver.iterations;
  const auto* const cairn = dynamic_cast<const bullet::ConstraintSolver*>(made.get());
  TensionRun run;
  Observer observer(cell, world);
  const int steps = static_cast<int>(std::lround(options.seconds * cell.rate));
  double cpu = 0;
  for (int step = 0; step < steps; ++step) {
    {
      const cli::SummedTime summed(cli::SolverClock::kThreadCpu, &cpu);
      world.Step();
    }
    run.failure = watched.failure();
    if (!run.failure.empty()) {
      run.gap = run.energy_gain = run.spin_change = std::numeric_limits<double>::infinity();
      return run;
    }
    observer.See(step, &run);
    if (cairn != nullptr) run.steps_taken += cairn->report().steps_accepted;
  }
  run.cpu_us = 1e3 * cpu / steps;
  run.steps_taken /= steps;
  return run;
}

TensionRun RunReference(const TensionCell& cell, const TensionOptions& options) {
  TensionCell finer = cell;
  finer.rate = TensionOptions::kReferenceRate;
  Settings settings;
  settings.step_policy = StepPolicy::kAlways;
  return RunCell(finer, Cairn("reference", "", settings, {.geometric_stiffness = false}), options);
}

TensionDifference Compare(const TensionRun& run, const TensionRun& reference, double length) {
  TensionDifference result{.period = kNotMeasured, .load = kNotMeasured};
  const size_t crossings = std::min(run.crossings.size(), reference.crossings.size());
  if (crossings > 0) {
    result.period = run.crossings[crossings - 1] / reference.crossings[crossings - 1] - 1;
  }
  const size_t looks = std::min(run.load.size(), reference.load.size());
  if (looks == 0 || !run.failure.empty()) return result;
  result.load = 0;
  for (size_t i = 0; i < looks; ++i) {
    const auto distance = static_cast<double>((run.load[i] - reference.load[i]).length());
    result.load = std::max(result.load, distance / length);
  }
  return result;
}

}  // namespace cairn::accuracy
