// SPDX-License-Identifier: MIT
#include "cycle/cycle_sweeps.h"

#include <algorithm>

#include "cairn/detail/spans.h"
#include "simd/flush_denormals.h"

namespace cairn {

void CycleSweeps::Begin(const CycleFrame& frame, BlockSweeps* sweeps, CycleIslands* islands,
                        Nncg* nncg) {
  frame_ = &frame;
  sweeps_ = sweeps;
  islands_ = islands;
  nncg_ = nncg;
}

bool CycleSweeps::Sweep(int count, std::span<GroupSweeps> groups, Steps steps) {
  if (!frame_->accelerates()) {
    const bool whole = sweeps_->Sweep(count, groups);
    if (whole && count > 0) islands_->See(groups, sweeps_);
    return whole;
  }
  if (sweeps_->InOneGo()) {
    SweepGroupByGroup(count, groups, steps);
    return true;
  }
  for (bool whole = true; count > 0; --count) {
    if (MoveOn(groups, steps)) {
      sweeps_->SweepWhole(groups);
    } else {
      whole = sweeps_->Sweep(1, groups);
    }
    if (!whole) return false;
    sweeps_->ErrorsOfIslands(groups, islands_->sights(), [&](int g) {
      islands_->See(g);
      LearnDirections(g, groups[g].sweeps, steps);
    });
  }
  return true;
}

void CycleSweeps::SweepGroupByGroup(int count, std::span<GroupSweeps> groups, Steps steps) {
  const Plan& plan = frame_->plan();
  // one for all kernels; clocks of others do not get to see it
  const simd::FlushDenormals flush;
  const bool moves = AnyMoves(steps);
  const bool starts = moves && nncg_->StartsFrom(frame_->blocks->blocks(), frame_->crew);
  const double rows = RowsOf(plan, groups);
  for (int g = 0; g < static_cast<int>(plan.groups().size()); ++g) {
    GroupSweeps& group = groups[g];
    if (!group.active) continue;
    for (int k = 0; k < count; ++k) {
      const SpanClock clock(frame_->settings.tuning.spans, 0, {SpanKind::kSweep, group.sweeps});
      if (moves && !(starts && k == 0)) nncg_->MoveGroupOn(g, frame_->blocks);
      sweeps_->SweepGroup(g, group.sweeps++);
      sweeps_->ErrorsOfGroup(plan.groups()[g], islands_->sights());
      LearnDirections(g, group.sweeps, steps);
    }
    if (count > 0) islands_->See(g);
  }
  for (int k = 0; k < count; ++k) {
    if (moves) frame_->meter->Charge(WorkKind::kSweep, Nncg::kSweeps * rows);
    frame_->meter->Charge(WorkKind::kSweep, rows);
  }
}

void CycleSweeps::LearnDirections(int group, int sweeps, Steps steps) {
  for (const int i : frame_->plan().islands_in(frame_->plan().groups()[group])) {
    if (steps == Steps::kIn && (*islands_)[i].stepped()) {
      nncg_->Forget(i);
    } else {
      nncg_->See(i, islands_->last_seen(i).energy);
    }
  }
  nncg_->ForgetWhereRowsEnd(group, sweeps);
}

bool CycleSweeps::AnyMoves(Steps steps) const {
  if (steps == Steps::kUndone) return true;
  const std::span<const IslandProgress> states = islands_->states();
  return !std::all_of(states.begin(), states.end(), [](const auto& i) { return i.stepped(); });
}

bool CycleSweeps::MoveOn(std::span<const GroupSweeps> groups, Steps steps) {
  if (!AnyMoves(steps)) return false;
  BudgetMeter& meter = *frame_->meter;
  const double rows = RowsOf(frame_->plan(), groups);
  if (!meter.Fits(0, (1 + Nncg::kSweeps) * rows)) {
    nncg_->ForgetAll();
    return false;
  }
  meter.Begin();
  nncg_->MoveOn(groups, frame_->crew, frame_->blocks);
  meter.Charge(WorkKind::kSweep, Nncg::kSweeps * rows);
  return true;
}

}  // namespace cairn
