// SPDX-License-Identifier: MIT
#include "small/same_states.h"

#include "measure/reference.h"

namespace cairn::cli {
namespace {

/// Of the solver that makes the states: enough for worlds to be what they should be.
constexpr int kIterationsOfStates = 200;

}  // namespace

SameStates::SameStates(const SceneChoice& scene, const Setup& setup)
    : run_(scene, kIterationsOfStates),
      reference_(
          bench::ReferenceSettings(),
          {.geometric_stiffness = false, .resting_slop = false, .two_friction_directions = false}) {
  for (SolverChoice solver : SmallSolvers()) {
    solver.threads = setup.threads;
    shadows_.push_back(std::make_unique<Shadow>());
    shadows_.back()->contestant = solver.MakeForSameStates();
  }
}

std::vector<Velocity> SameStates::Solve(const bench::Substep& substep,
                                        const btContactSolverInfo& info, Shadow* shadow) {
  shadow->info = info;
  shadow->contestant->Begin({}, &shadow->info);
  substep.Restore();
  shadow->joints.Put(substep);
  substep.SolveWith(shadow->contestant->solver(), shadow->info, nullptr);
  shadow->joints.Keep(substep);
  return bench::ReadVelocities(substep.bodies());
}

void SameStates::Step(SmallResult* result) {
  run_.StepAfter([this, result](bench::Substep* substep, const btContactSolverInfo& info) {
    std::vector<Velocity> truth;
    if (result != nullptr) {
      substep->Restore();
      substep->SolveWith(&reference_, info, nullptr);
      truth = bench::ReadVelocities(substep->bodies());
      result->reference_residuals.push_back(reference_.report().residual_max);
    }
    for (size_t i = 0; i < shadows_.size(); ++i) {
      const std::vector<Velocity> velocities = Solve(*substep, info, shadows_[i].get());
      if (result == nullptr) continue;
      result->solvers[i].errors.push_back(bench::VelocityError(truth, velocities));
    }
  });
}

}  // namespace cairn::cli
