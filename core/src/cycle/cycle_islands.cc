// SPDX-License-Identifier: MIT
#include "cycle/cycle_islands.h"

#include <algorithm>
#include <utility>

namespace cairn {

double RowsOf(const Plan& plan, std::span<const GroupSweeps> groups) {
  double rows = 0;
  for (size_t g = 0; g < groups.size(); ++g) {
    if (groups[g].active) rows += static_cast<double>(plan.groups()[g].rows);
  }
  return rows;
}

void SweepRun::Begin(int first, int sweeps_made, double energy) {
  begin = first;
  start = quarter = half = {sweeps_made - first, energy};
}

void SweepRun::See(int sweeps_made, double energy) {
  const int sweeps = sweeps_made - begin;
  if (half.sweeps == 0) {
    Begin(0, sweeps_made, energy);
  } else if (sweeps >= 2 * half.sweeps) {
    quarter = std::exchange(half, {sweeps, energy});
  }
}

bool IslandProgress::MayStep() {
  const bool was_judged = phase_ == Phase::kJudged;
  if (was_judged) phase_ = Phase::kSweeping;
  return !was_judged && sweeping() && !too_late_;
}

void CycleIslands::Begin(const Plan& plan, NoStep no_step) {
  plan_ = &plan;
  states_.assign(plan.islands().size(), {});
  IslandReport fresh;
  fresh.no_step = no_step;
  reports_.assign(plan.islands().size(), fresh);
  groups_.assign(plan.groups().size(), {.active = true});
  not_done_.clear();
  for (const Group& group : plan.groups()) not_done_.push_back(group.islands);
  stopped_.clear();
  stopped_.reserve(plan.islands().size());
  if (last_seen_.size() < states_.size()) last_seen_.resize(states_.size());
}

bool CycleIslands::active() const {
  return std::any_of(groups_.begin(), groups_.end(), [](const GroupSweeps& g) { return g.active; });
}

double CycleIslands::ActiveRows() const { return RowsOf(*plan_, groups_); }

int CycleIslands::SweepsMade() const {
  for (const GroupSweeps& group : groups_) {
    if (group.active) return group.sweeps;
  }
  return 0;
}

int CycleIslands::StepsTaken(int island) const {
  return reports_[island].steps_accepted + reports_[island].steps_restored;
}

void CycleIslands::See(std::span<const GroupSweeps> groups, BlockSweeps* sweeps) {
  sweeps->ErrorsOfIslands(groups, last_seen_, [this](int g) { See(g); });
}

void CycleIslands::See(int group) {
  for (const int i : plan_->islands_in(plan_->groups()[group])) {
    if (!states_[i].done()) states_[i].seen = last_seen_[i];
  }
}

void CycleIslands::SeeRuns() {
  const int sweeps = SweepsMade();
  for (IslandProgress& island : states_) {
    if (island.open()) island.run.See(sweeps, island.seen.energy);
  }
}

void CycleIslands::Stop(int island, StopReason reason) {
  reports_[island].stop = reason;
  reports_[island].sweeps = group_of(island).sweeps;
  states_[island].Stop();
  --not_done_[plan_->islands()[island].group];
  stopped_.push_back(island);
}

void GroupChoice::Begin(const Plan& plan) {
  plan_ = &plan;
  groups_.assign(plan.groups().size(), {});
}

void GroupChoice::Clear() {
  for (GroupSweeps& group : groups_) group.active = false;
}

void GroupChoice::AddAll() {
  for (GroupSweeps& group : groups_) group.active = true;
}

double GroupChoice::Rows() const { return RowsOf(*plan_, groups_); }

}  // namespace cairn
