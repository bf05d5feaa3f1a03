// SPDX-License-Identifier: MIT
#include "effort/error_sampler.h"

#include <algorithm>
#include <cmath>

#include "measure/reference.h"
#include "support/statistics.h"

namespace cairn::cli {

ErrorSampler::ErrorSampler(std::span<const SolverChoice> solvers,
                           const btContactSolverInfo& defaults)
    : reference_(std::make_unique<bullet::ConstraintSolver>(
          bench::ReferenceSettings(),
          bullet::Options{.resting_slop = false, .two_friction_directions = false})),
      defaults_(defaults) {
  for (const SolverChoice& choice : solvers) {
    contestants_.push_back(choice.MakeForSameStates());
    in_parts_.push_back(choice.entry->parts > 1);
  }
}

void ErrorSampler::AddLadders(std::span<const SolverChoice> solvers, double most) {
  std::vector<const SolverEntry*> kinds;
  for (const SolverChoice& choice : solvers) {
    const auto known = std::find(kinds.begin(), kinds.end(), choice.entry);
    ladder_of_.push_back(known - kinds.begin());
    if (known != kinds.end()) continue;
    kinds.push_back(choice.entry);
    ladders_.push_back(std::make_unique<EffortLadder>(choice, defaults_, most));
  }
}

void ErrorSampler::WarmUp(bench::Substep* substep, std::span<const Effort> efforts) {
  for (size_t i = 0; i < contestants_.size(); ++i) {
    btContactSolverInfo info = defaults_;
    contestants_[i]->Begin(efforts[i], &info);
    substep->Restore();
    substep->SolveWith(contestants_[i]->solver(), info, nullptr);
  }
  for (const auto& ladder : ladders_) ladder->WarmUp(substep);
}

ErrorSampler::Errors ErrorSampler::Measure(bench::Substep* substep,
                                           std::span<const Effort> efforts) {
  substep->Restore();
  substep->SolveWith(reference_.get(), defaults_, nullptr);
  const std::vector<Velocity> truth = bench::ReadVelocities(substep->bodies());

  Errors errors;
  errors.reference_residual = reference_->report().residual_max;
  for (size_t i = 0; i < contestants_.size(); ++i) {
    btContactSolverInfo info = defaults_;
    contestants_[i]->Begin(efforts[i], &info);
    substep->Restore();
    substep->SolveWith(contestants_[i]->solver(), info, nullptr);
    const bool refused = !contestants_[i]->refusal().empty() || in_parts_[i];
    const double error = bench::VelocityError(truth, bench::ReadVelocities(substep->bodies()));
    errors.of_solvers.push_back(refused ? kNotMeasured : error);
  }
  std::vector<std::vector<CurvePoint>> curves;
  for (const auto& ladder : ladders_) curves.push_back(ladder->Measure(substep, truth));
  for (const size_t ladder : ladder_of_) errors.curves.push_back(curves[ladder]);
  return errors;
}

}  // namespace cairn::cli
