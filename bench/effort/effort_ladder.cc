// SPDX-License-Identifier: MIT
#include "effort/effort_ladder.h"

#include <algorithm>
#include <chrono>

#include "measure/reference.h"
#include "support/duration.h"
#include "support/machine/stopwatch.h"

namespace cairn::cli {
namespace {

constexpr int kIterations[] = {1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000};
constexpr double kBudgets[] = {0.03, 0.06, 0.125, 0.25, 0.5, 1, 2, 4, 8, 16, 32, 64};  // [ms]

std::vector<Effort> Efforts(const SolverEntry& entry) {
  const Control control = entry.control;
  std::vector<Effort> efforts;
  if (entry.parts > 1) return efforts;
  if (control == Control::kNone) return {Effort{}};
  if (control == Control::kIterations) {
    for (const int iterations : kIterations)
      efforts.push_back({.iterations = iterations, .budget = {}, .units = {}});
    return efforts;
  }
  for (const double budget : kBudgets) {
    const auto time = std::chrono::nanoseconds(static_cast<long long>(budget * 1e6));
    efforts.push_back({.iterations = 10, .budget = time, .units = {}});
  }
  return efforts;
}

}  // namespace

EffortLadder::EffortLadder(const SolverChoice& choice, const btContactSolverInfo& defaults,
                           double most)
    : choice_(choice), defaults_(defaults), most_(most) {}

double EffortLadder::Solve(const Rung& rung, bench::Substep* substep) const {
  btContactSolverInfo info = defaults_;
  rung.contestant->Begin(rung.effort, &info);
  substep->Restore();
  const Stopwatch stopwatch(SolverClock::kWall);
  substep->SolveWith(rung.contestant->solver(), info, nullptr);
  return stopwatch.Read();
}

void EffortLadder::Build(bench::Substep* substep) {
  for (const Effort& effort : Efforts(*choice_.entry)) {
    if (effort.budget && Milliseconds(*effort.budget) > most_) return;
    const Rung& rung = rungs_.emplace_back(Rung{effort, choice_.MakeForSameStates()});
    // the first time is that of a cold start
    const double cold = Solve(rung, substep), warm = Solve(rung, substep);
    if (!effort.budget && std::min(cold, warm) > most_) return;
  }
}

void EffortLadder::WarmUp(bench::Substep* substep) {
  if (rungs_.empty()) return Build(substep);
  for (const Rung& rung : rungs_) Solve(rung, substep);
}

std::vector<CurvePoint> EffortLadder::Measure(bench::Substep* substep,
                                              std::span<const Velocity> truth) {
  std::vector<CurvePoint> points;
  for (const Rung& rung : rungs_) {
    const double time = Solve(rung, substep);
    if (!rung.contestant->refusal().empty()) continue;
    const Work work = rung.contestant->work();
    points.push_back(
        {.time = time,
         .error = bench::VelocityError(truth, bench::ReadVelocities(substep->bodies())),
         .iterations = work.iterations,
         .factorisations = work.factorisations});
  }
  return points;
}

}  // namespace cairn::cli
