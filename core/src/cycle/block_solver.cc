// SPDX-License-Identifier: MIT
#include "cycle/block_solver.h"

#include <algorithm>
#include <cmath>

#include "cairn/detail/threads.h"
#include "problem/relaxation.h"

namespace cairn {
namespace {

/// Sums of energy are not finite if a term is not.
bool AreFinite(std::span<const IslandReport> islands) {
  return std::all_of(islands.begin(), islands.end(), [](const IslandReport& island) {
    return std::isfinite(island.residual.energy);
  });
}

}  // namespace

PackResult BlockSolver::Solve(const ContactProblem& problem, const Settings& settings,
                              BudgetMeter* meter, const Impulses& impulses,
                              std::span<Velocity> velocities, Report* report) {
  // waiting for another thread would cost more than it does, where there is little to do
  const int threads = detail::ThreadsFor(static_cast<int>(AllRows(problem)), settings.threads);
  Crew* const crew = threads == 1 ? &alone_ : crew_;
  alone_.RecordTo(settings.tuning.spans);
  const detail::AwakeHelpers awake(crew, crew->called() ? 1 : threads);  // or somebody else does
  const PackResult begun = Begin(problem, settings, impulses, crew);
  if (begun != PackResult::kDone) return begun;
  cycle_.Run({problem, settings, &frame_, &memories_, meter, crew}, report);
  if (!frame_.IsFinite() || !AreFinite(report->islands)) {
    // nothing that came of it is to be remembered
    cycle_ = {};
    memories_ = {};
    report->islands.clear();
    return PackResult::kOutOfRange;
  }
  const SpanClock clock(settings.tuning.spans, 0, {SpanKind::kResults});
  frame_.End(problem, crew, impulses, velocities);
  return PackResult::kDone;
}

PackResult BlockSolver::Begin(const ContactProblem& problem, const Settings& settings,
                              const Impulses& impulses, Crew* crew) {
  const SpanClock clock(settings.tuning.spans, 0, {SpanKind::kSetUp});
  return frame_.Begin(problem, OmegaOf(settings), impulses, crew);
}

}  // namespace cairn
