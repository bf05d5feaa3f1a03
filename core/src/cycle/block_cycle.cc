// SPDX-License-Identifier: MIT
#include "cycle/block_cycle.h"

#include <algorithm>
#include <bit>

#include "cairn/detail/spans.h"
#include "sweep/settle_friction.h"

namespace cairn {
namespace {

/// Sweeps between two looks at how far the islands have come. The first look is after one sweep:
/// what rests need not be swept again. From the second on what sweeps gain is learnt; see StepOdds.
constexpr int kMostSweepsUnseen = 8;
constexpr int kMarkedSweep = kGuardedSweep;

int UnseenAfter(int sweeps) {
  if (sweeps == 0) return 1;
  return sweeps < kMarkedSweep ? kMarkedSweep - sweeps : kMostSweepsUnseen;
}

/// An island is measured when its last sweep saw errors of at most so many tolerances: they are
/// those of states on the way, not of the last one.
constexpr double kNearTolerance = 2;

/// What looking at a state and keeping a copy costs, in sweeps.
constexpr double kKeepingSweeps = 1;

/// What impulses are multiplied by where an island that sweeps leave unfinished begins. They catch
/// up with a load too late and go on too far, so that stacks rock and beams swing up.
constexpr float kSoftStart = 0.85f;

}  // namespace

void BlockCycle::Run(const CycleFrame& frame, Report* report) {
  BlockSweeps sweeps(frame.blocks, frame.settings, frame.meter, frame.crew);
  frame_ = &frame;
  sweeps_ = &sweeps;
  steps_.Begin(frame);
  Begin();
  SoftenStart();
  while (islands_.active()) Round();
  Finish();
  if (frame.accelerates()) RememberEnds();
  if (frame.learns()) planner_.Learn();
  FillReport(report);
}

void BlockCycle::Begin() {
  const Plan& plan = frame_->plan();
  islands_.Begin(plan, steps_.asked() ? NoStep::kEnded : NoStep::kNotAsked);
  planner_.Begin(*frame_, &steps_, &islands_);
  cycle_sweeps_.Begin(*frame_, sweeps_, &islands_, &nncg_);
  trials_.Begin(*frame_, {&steps_, &planner_, &islands_, sweeps_, &cycle_sweeps_, &nncg_});
  chosen_.Begin(plan);
  Residual none;
  none.energy = kInfinity;
  bests_.assign(plan.islands().size(), none);
  rounds_ = 0;
  started_ = false;
  nncg_.Begin(*frame_->blocks);
  if (after_.size() < plan.islands().size()) after_.resize(plan.islands().size());
  done_.Reserve(*frame_->data());
  if (frame_->meter->limited()) best_.Reserve(*frame_->data());
  if (frame_->settings.max_sweeps > 0) return;
  for (int i = 0; i < islands_.count(); ++i) islands_.Stop(i, StopReason::kSweepLimit);
  CloseGroups();
}

void BlockCycle::SoftenStart() {
  if (!frame_->accelerates() || frame_->meter->limited()) return;
  scales_.assign(islands_.count(), 1);
  bool any = false;
  for (int i = 0; i < islands_.count(); ++i) {
    if (!steps_.Overshoots(i)) continue;
    scales_[i] = kSoftStart;
    any = true;
  }
  if (!any) return;
  LeaveForced(frame_->plan(), *frame_->data(), scales_);
  ScaleIslands(frame_->plan(), scales_, frame_->data());
}

void BlockCycle::RememberEnds() {
  for (int i = 0; i < islands_.count(); ++i) {
    const IslandReport& report = islands_.report(i);
    steps_.EndSolve(i, report.steps_accepted > 0, report.stop != StopReason::kSweepLimit);
  }
}

void BlockCycle::GuardStart(int sweeps) {
  if (!IsGuarded(frame_->settings)) return;
  const auto due = [this, sweeps](int i) {
    return !islands_[i].done() && sweeps == GuardedSweep(frame_->plan().islands()[i].joints);
  };
  bool any = false;
  chosen_.Clear();
  for (int i = 0; i < islands_.count(); ++i) {
    if (!due(i)) continue;
    chosen_.Add(i);
    any = true;
  }
  if (!any) return;
  const SpanClock clock(frame_->settings.tuning.spans, 0, {SpanKind::kGuard});
  merits_.Find(frame_->blocks, chosen_.groups());
  scales_.assign(islands_.count(), 1);
  any = false;
  for (int i = 0; i < islands_.count(); ++i) {
    if (!due(i) || !merits_.of(i).is_worse_than_none()) continue;
    scales_[i] = static_cast<float>(merits_.of(i).best_scale());
    islands_.report(i).guards.start = true;
    nncg_.Forget(i);
    any = true;
  }
  if (any) ScaleIslands(frame_->plan(), scales_, frame_->data());
}

void BlockCycle::GuardResult() {
  const SpanClock clock(frame_->settings.tuning.spans, 0, {SpanKind::kGuard});
  chosen_.AddAll();
  merits_.Find(frame_->blocks, chosen_.groups());
  if (!IsGuarded(frame_->settings)) return;
  chosen_.Clear();
  scales_.assign(islands_.count(), 1);
  bool any = false;
  for (int i = 0; i < islands_.count(); ++i) {
    if (!merits_.of(i).is_worse_than_none()) continue;
    scales_[i] = static_cast<float>(merits_.of(i).best_scale());
    islands_.report(i).guards.result = true;
    if (steps_.asked()) steps_.Guarded(i);
    chosen_.Add(i);
    any = true;
  }
  if (!any) return;
  ScaleIslands(frame_->plan(), scales_, frame_->data());
  sweeps_->MeasureFree(chosen_.groups());
  ReadErrors();
  merits_.Find(frame_->blocks, chosen_.groups());
}

void BlockCycle::ReadErrors() { sweeps_->ErrorsOfIslands(chosen_.groups(), after_); }

void BlockCycle::CloseGroups() {
  // the lanes go on while another island of the group does
  islands_.CloseGroups([this](int i) { done_.Take(frame_->plan(), i, *frame_->data()); });
}

void BlockCycle::Round() {
  // what came after the last round may have taken what was left
  if (rounds_ > 0 && !trials_.pending() && frame_->meter->Late(0)) StopLate();
  if (!islands_.active()) return;
  const Settings& settings = frame_->settings;
  const int before = islands_.SweepsMade();
  const bool more = frame_->weighs_steps() && before >= settings.max_sweeps;
  const int end =
      before + (more ? frame_->sweeps_of_round()
                     : std::min(frame_->sweeps_of_round(), settings.max_sweeps - before));
  for (bool whole = true; whole && islands_.active() && islands_.SweepsMade() < end;) {
    const int unseen = UnseenAfter(islands_.SweepsMade());
    whole = cycle_sweeps_.Sweep(std::min(end - islands_.SweepsMade(), unseen), islands_.groups(),
                                CycleSweeps::Steps::kIn);
    const int made = islands_.SweepsMade();
    if (whole && made == 1) MarkStart();
    if (whole && made <= kGuardedSweep) GuardStart(made);
    if (whole && made >= kMarkedSweep) islands_.SeeRuns();
    if (!whole || made == end) trials_.Judge(made - before);
    JudgeIslands(whole);
  }
  ++rounds_;
  KeepBest();
  if (islands_.active()) trials_.Take(planner_.PlanRound());
}

void BlockCycle::MarkStart() {
  started_ = true;
  for (int i = 0; i < islands_.count(); ++i) islands_.report(i).residual_before = islands_[i].seen;
}

void BlockCycle::JudgeIslands(bool seen) {
  const Settings& settings = frame_->settings;
  const double unit = UnitOf(settings);
  for (int i = 0; i < islands_.count() && seen; ++i) {
    if (islands_[i].open() && IsWithin(islands_[i].seen, settings.tuning.min_progress, unit)) {
      islands_.Stop(i, StopReason::kStationary);
    }
  }
  if (seen && settings.tolerance > 0) JudgeNear();
  for (int i = 0; i < islands_.count(); ++i) {
    if (!islands_[i].open()) continue;
    const int sweeps = islands_.group_of(i).sweeps;
    if (frame_->meter->spent() && sweeps >= LeastSweeps(settings)) {
      islands_.Stop(i, frame_->meter->stop_reason());
    } else if (sweeps >= settings.max_sweeps && sweeps >= planner_.MostSweeps(i)) {
      islands_.Stop(i, StopReason::kSweepLimit);
    }
  }
  CloseGroups();
}

void BlockCycle::StopLate() {
  for (int i = 0; i < islands_.count(); ++i) {
    if (islands_[i].open() && islands_.group_of(i).sweeps >= LeastSweeps(frame_->settings)) {
      islands_.Stop(i, frame_->meter->stop_reason());
    }
  }
  CloseGroups();
}

void BlockCycle::JudgeNear() {
  // near the solution, the state itself is measured
  const double tolerance = frame_->settings.tolerance, unit = UnitOf(frame_->settings);
  const auto near = [&](int i) {
    return islands_[i].open() && IsWithin(islands_[i].seen, kNearTolerance * tolerance, unit);
  };
  chosen_.Clear();
  bool any = false;
  for (int i = 0; i < islands_.count(); ++i) {
    if (!near(i)) continue;
    chosen_.Add(i);
    any = true;
  }
  if (!any) return;
  sweeps_->Measure(chosen_.groups());
  ReadErrors();
  for (int i = 0; i < islands_.count(); ++i) {
    if (near(i) && IsWithin(after_[i], tolerance, unit)) islands_.Stop(i, StopReason::kConverged);
  }
}

void BlockCycle::KeepBest() {
  // after 1, 2, 4, 8 ... rounds: that costs little, and the last one is never far behind
  BudgetMeter& meter = *frame_->meter;
  if (!meter.limited() || !std::has_single_bit(static_cast<unsigned>(rounds_))) return;
  chosen_.Clear();
  for (int i = 0; i < islands_.count(); ++i) {
    if (!islands_[i].done()) chosen_.Add(i);
  }
  if (!islands_.active() || meter.Late(kKeepingSweeps * chosen_.Rows())) return;
  sweeps_->MeasureFree(chosen_.groups());
  ReadErrors();
  for (int i = 0; i < islands_.count(); ++i) {
    if (islands_[i].done() || after_[i].energy >= bests_[i].energy) continue;
    best_.Take(frame_->plan(), i, *frame_->data());
    bests_[i] = after_[i];
  }
}

bool BlockCycle::Settles(int i) const {
  const IslandReport& report = islands_.report(i);
  // joints would gape by what friction leaves them
  return !frame_->plan().islands()[i].joints && report.stop == StopReason::kSweepLimit &&
         report.sweeps > 0;
}

void BlockCycle::SettleFriction() {
  if (!SettlesFriction(frame_->settings) || frame_->meter->limited()) return;
  chosen_.Clear();
  bool any = false;
  for (int i = 0; i < islands_.count(); ++i) {
    if (!Settles(i)) continue;
    chosen_.Add(i);
    any = true;
  }
  if (!any) return;
  // those that share lanes with them stay as they are
  const auto for_others = [this](const auto& function) {
    for (int i = 0; i < islands_.count(); ++i) {
      if (chosen_.Has(i) && !Settles(i)) function(i);
    }
  };
  for_others([this](int i) { done_.Take(frame_->plan(), i, *frame_->data()); });
  for (size_t g = 0; g < chosen_.groups().size(); ++g) {
    // rows that took part in the last sweep do
    chosen_.groups()[g].sweeps = std::max(0, islands_.groups()[g].sweeps - 1);
  }
  sweeps_->SweepFriction(chosen_.groups());
  for_others([this](int i) { done_.Restore(frame_->plan(), i, frame_->data()); });
}

void BlockCycle::Finish() {
  const Plan& plan = frame_->plan();
  // islands that were done before others of their group
  for (int i = 0; i < islands_.count(); ++i) {
    if (islands_.report(i).sweeps < islands_.group_of(i).sweeps) {
      done_.Restore(plan, i, frame_->data());
    }
  }
  SettleFriction();
  chosen_.AddAll();
  sweeps_->MeasureFree(chosen_.groups());
  ReadErrors();

  // sweeps may also make it worse, where friction bounds move: then the best state there was
  for (int i = 0; i < islands_.count(); ++i) {
    const bool better = bests_[i].energy < after_[i].energy;
    if (!better || islands_.report(i).stop == StopReason::kConverged) continue;
    best_.Restore(plan, i, frame_->data());
    after_[i] = bests_[i];
  }
  GuardResult();
}

void BlockCycle::FillReport(Report* report) const {
  const Plan& plan = frame_->plan();
  const std::span<const int> island_of = plan.island_of_body();
  report->island_of.assign(island_of.begin(), island_of.end());
  report->islands.resize(islands_.count());
  for (int i = 0; i < islands_.count(); ++i) {
    IslandReport& island = report->islands[i] = islands_.report(i);
    island.first_body = plan.islands()[i].first_body;
    island.bodies = plan.islands()[i].bodies;
    island.rows = plan.islands()[i].rows;
    island.residual = after_[i];
    island.merit = merits_.of(i).value();
    if (!started_) island.residual_before = island.residual;
  }
}

}  // namespace cairn
