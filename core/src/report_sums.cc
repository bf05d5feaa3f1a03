// SPDX-License-Identifier: MIT
#include "report_sums.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "reference/residual.h"

namespace cairn {
namespace {

/// Which of two reasons says more about why the whole did not get further.
StopReason WorseOf(StopReason a, StopReason b) { return std::max(a, b); }

void Add(const IslandReport& part, IslandReport* sum) {
  const IslandReport before = *sum;
  *sum = part;
  sum->residual_before = before.residual_before;
  sum->merit += before.merit;
  sum->guards.start |= before.guards.start;
  sum->guards.step |= before.guards.step;
  sum->guards.result |= before.guards.result;
  sum->sweeps += before.sweeps;
  sum->factorisations += before.factorisations;
  sum->steps_accepted += before.steps_accepted;
  sum->steps_restored += before.steps_restored;
  sum->step_work += before.step_work;
  sum->stop = WorseOf(before.stop, part.stop);
}

}  // namespace

void ForgetReport(Report* report) {
  Array<IslandReport> islands = std::move(report->islands);
  Array<int> island_of = std::move(report->island_of);
  Replay replay = std::move(report->replay);
  islands.clear();
  island_of.clear();
  replay.fits.clear();
  replay.work = Replay{}.work;
  *report = Report{};
  report->islands = std::move(islands);
  report->island_of = std::move(island_of);
  report->replay = std::move(replay);
}

void CopyJudgement(const Report& checked, Report* report) {
  report->status = checked.status;
  report->bad_setting = checked.bad_setting;
  report->bad_row = checked.bad_row;
  report->bad_body = checked.bad_body;
  report->bad_manifold = checked.bad_manifold;
  report->bad_joint = checked.bad_joint;
}

void Add(const Report& part, Report* sum) {
  sum->path = std::max(sum->path, part.path);
  sum->work += part.work;
  sum->step_predicted += part.step_predicted;
  sum->step_time += part.step_time;
  sum->island_of = part.island_of;
  const bool alike = sum->islands.size() == part.islands.size();
  if (!alike) sum->islands = part.islands;
  for (size_t i = 0; i < part.islands.size() && alike; ++i) Add(part.islands[i], &sum->islands[i]);
}

void SumUp(Report* report) {
  report->stop = report->islands.empty() ? StopReason::kConverged : StopReason::kNotStarted;
  for (const IslandReport& island : report->islands) {
    Accumulate(island.residual, report);
    report->sweeps = std::max(report->sweeps, island.sweeps);
    report->factorisations += island.factorisations;
    report->steps_accepted += island.steps_accepted;
    report->steps_restored += island.steps_restored;
    report->guarded += island.guards.any() ? 1 : 0;
    report->stop = WorseOf(report->stop, island.stop);
  }
}

void TellStrains(std::span<const Body> bodies, int substeps, Report* report) {
  constexpr double kCalm = 2;  // below, stiffness leaves bodies alone
  for (size_t i = 0; i < bodies.size(); ++i) {
    const int at = report->island_of[i];
    if (at < 0 || !(bodies[i].strain > report->islands[at].strain)) continue;
    IslandReport& island = report->islands[at];
    island.strain = bodies[i].strain;
    island.strained_body = static_cast<int>(i);
    // strain falls with the square of the number of parts
    const double enough = std::ceil(substeps * std::sqrt(island.strain / kCalm));
    island.enough_substeps = static_cast<int>(std::clamp(enough, 1.0, 1e6));
  }
}

}  // namespace cairn
