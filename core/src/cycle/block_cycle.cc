// SPDX-License-Identifier: MIT
#include "cycle/block_cycle.h"

#include <algorithm>
#include <bit>

#include "cairn/detail/spans.h"

namespace cairn {
namespace {

/// Sweeps between two looks at how far the islands have come. The first look is after one sweep:
/// what rests need not be swept again. From the second on what sweeps gain is learnt; see StepOdds.
constexpr int kMostSweepsUnseen = 8;
constexpr int kMarkedSweep = 3;

int UnseenAfter(int sweeps) {
  if (sweeps == 0) return 1;
  return sweeps < kMarkedSweep ? kMarkedSweep - sweeps : kMostSweepsUnseen;
}

/// An island is measured when its last sweep saw errors of at most so many tolerances: they are
/// those of states on the way, not of the last one.
constexpr double kNearTolerance = 2;

/// What looking at a state and keeping a copy costs, in sweeps.
constexpr double kKeepingSweeps = 1;

}  // namespace

void BlockCycle::Run(const ContactProblem& problem, const Settings& settings, BlockFrame* frame,
                     IslandMemories* memories, BudgetMeter* meter, Crew* crew, Report* report) {
  BlockSweeps sweeps(frame, settings, meter, crew);
  settings_ = &settings;
  frame_ = frame;
  meter_ = meter;
  sweeps_ = &sweeps;
  crew_ = crew;
  // a budget is shared by steps and sweeps: what both gain is watched
  const bool asked = settings.method == Method::kPgsSm && settings.k_sm > 0;
  watches_ = asked && meter->limited() && settings.step_policy != StepPolicy::kAlways;
  weighs_ = asked && !meter->limited() && settings.step_policy == StepPolicy::kWeighed;
  steps_.Begin(problem, settings, frame, memories, meter, crew, asked);
  Begin();
  GuardStart();
  while (Active()) Leg();
  Finish();
  if (Learns()) Learn();
  FillReport(report);
}

void BlockCycle::Begin() {
  const Plan& plan = frame_->plan();
  made_.assign(plan.groups().size(), {.active = true});
  chosen_.assign(plan.groups().size(), {});
  IslandState fresh;
  fresh.best.energy = kInfinity;
  states_.assign(plan.islands().size(), fresh);
  IslandReport fresh_report;
  if (steps_.asked()) fresh_report.no_step = NoStep::kEnded;
  islands_.assign(plan.islands().size(), fresh_report);
  stepped_islands_.clear();
  stopped_.clear();
  stopped_.reserve(islands_.size());
  legs_ = 0;
  started_ = false;
  accelerates_ =
      settings_->method == Method::kPgsSm && settings_->acceleration == Acceleration::kNncg;
  nncg_.Begin(*frame_);
  if (after_.size() < islands_.size()) after_.resize(islands_.size());
  done_.Reserve(frame_->blocks());
  if (meter_->limited()) best_.Reserve(frame_->blocks());
  if (settings_->max_sweeps > 0) return;
  for (size_t i = 0; i < islands_.size(); ++i) {
    islands_[i].stop = StopReason::kSweepLimit;
    made_[plan.islands()[i].group].active = false;
  }
}

void BlockCycle::GuardStart() {
  guards_ = IsGuarded(*settings_);
  if (!guards_) return;
  const SpanClock clock(settings_->tuning.spans, 0, {SpanKind::kGuard});
  merits_.Find(frame_, made_);
  scales_.assign(islands_.size(), 1);
  for (int i = 0; i < static_cast<int>(islands_.size()); ++i) {
    if (Done(i) || !merits_.of(i).is_worse_than_none()) continue;
    scales_[i] = static_cast<float>(merits_.of(i).best_scale());
    islands_[i].guards.start = true;
  }
  ScaleIslands(frame_->plan(), scales_, &frame_->blocks());
}

void BlockCycle::GuardResult() {
  const SpanClock clock(settings_->tuning.spans, 0, {SpanKind::kGuard});
  for (GroupSweeps& group : chosen_) group.active = true;
  merits_.Find(frame_, chosen_);
  ChooseNone();
  scales_.assign(islands_.size(), 1);
  bool any = false;
  for (int i = 0; i < static_cast<int>(islands_.size()); ++i) {
    if (!guards_ || !merits_.of(i).is_worse_than_none()) continue;
    scales_[i] = static_cast<float>(merits_.of(i).best_scale());
    islands_[i].guards.result = true;
    if (steps_.asked()) steps_.Guarded(i);
    Choose(i);
    any = true;
  }
  if (!any) return;
  ScaleIslands(frame_->plan(), scales_, &frame_->blocks());
  sweeps_->MeasureFree(chosen_);
  ReadErrors(&after_);
  merits_.Find(frame_, chosen_);
}

bool BlockCycle::Active() const {
  return std::any_of(made_.begin(), made_.end(), [](const GroupSweeps& g) { return g.active; });
}

double BlockCycle::RowsOf(std::span<const GroupSweeps> groups) const {
  double rows = 0;
  for (size_t g = 0; g < groups.size(); ++g) {
    if (groups[g].active) rows += static_cast<double>(frame_->plan().groups()[g].rows);
  }
  return rows;
}

int BlockCycle::SweepsMade() const {
  for (const GroupSweeps& group : made_) {
    if (group.active) return group.sweeps;
  }
  return 0;
}

int BlockCycle::MostSweeps(int island) const {
  return StepsTaken(island) > 0 ? settings_->max_sweeps : SweepsInPlace(island);
}

int BlockCycle::SweepsInPlace(int island) const {
  const int most = settings_->max_sweeps;
  if (!weighs_) return most;
  // in whole legs
  return most + (steps_.SweepsOfEffort(island, most) - most) / settings_->k_gs * settings_->k_gs;
}

void BlockCycle::Stop(int island, StopReason reason) {
  islands_[island].stop = reason;
  islands_[island].sweeps = made_[frame_->plan().islands()[island].group].sweeps;
  stopped_.push_back(island);
}

void BlockCycle::CloseGroups() {
  const Plan& plan = frame_->plan();
  for (int island : stopped_) {
    // the lanes go on while another island of the group does
    const int g = plan.islands()[island].group;
    const Group& group = plan.groups()[g];
    const auto others = plan.islands_of_groups().subspan(group.first_island, group.islands);
    made_[g].active = made_[g].active &&
                      !std::all_of(others.begin(), others.end(), [&](int i) { return Done(i); });
    if (made_[g].active) done_.Take(plan, island, frame_->blocks());
  }
  stopped_.clear();
}

void BlockCycle::ChooseNone() {
  for (GroupSweeps& group : chosen_) group.active = false;
}

void BlockCycle::MeasureChosen(std::vector<Residual>* residuals) {
  sweeps_->Measure(chosen_);
  ReadErrors(residuals);
}

void BlockCycle::ReadErrors(std::vector<Residual>* residuals) const {
  if (residuals->size() < islands_.size()) residuals->resize(islands_.size());
  sweeps_->ErrorsOfIslands(chosen_, *residuals);
}

void BlockCycle::Leg() {
  // what came after the last leg may have taken what was left
  if (legs_ > 0 && stepped_islands_.empty() && meter_->Late(0)) StopLate();
  if (!Active()) return;
  const int before = SweepsMade();
  const bool more = weighs_ && before >= settings_->max_sweeps;
  const int end = more ? before + settings_->k_gs
                       : before + std::min(settings_->k_gs, settings_->max_sweeps - before);
  for (bool whole = true; whole && Active() && SweepsMade() < end;) {
    const int unseen = UnseenAfter(SweepsMade());
    whole = Sweep(std::min(end - SweepsMade(), unseen));
    if (whole && SweepsMade() == 1) MarkStart();
    if (whole && SweepsMade() >= kMarkedSweep) MarkRuns();
    if (!whole || SweepsMade() == end) KeepBetterSteps(SweepsMade() - before);
    Judge(whole);
  }
  ++legs_;
  KeepBest();
  if (Active()) TakeSteps();
}

void BlockCycle::MarkStart() {
  started_ = true;
  for (size_t i = 0; i < islands_.size(); ++i) islands_[i].residual_before = states_[i].seen;
}

bool BlockCycle::Sweep(int count) {
  if (!accelerates_) {
    const bool whole = sweeps_->Sweep(count, made_);
    if (whole) See(made_);
    return whole;
  }
  for (bool whole = true; count > 0; --count) {
    if (MoveOn()) {
      sweeps_->SweepWhole(made_);
    } else {
      whole = sweeps_->Sweep(1, made_);
    }
    if (!whole) return false;
    See(made_);
    LearnWays();
  }
  return true;
}

void BlockCycle::LearnWays() {
  const Plan& plan = frame_->plan();
  for (int i = 0; i < static_cast<int>(islands_.size()); ++i) {
    if (!made_[plan.islands()[i].group].active) continue;
    // what a step leaves behind is rough, and wants to be smoothed, not carried on
    if (states_[i].stepped) {
      nncg_.Forget(i);
    } else {
      nncg_.See(i, after_[i].energy);
    }
  }
  nncg_.ForgetWhereRowsEnd(SweepsMade());
}

bool BlockCycle::MoveOn() {
  const bool all_stepped = std::all_of(states_.begin(), states_.end(),
                                       [](const IslandState& island) { return island.stepped; });
  if (all_stepped) return false;
  const double rows = ActiveRows();
  if (!meter_->Fits(0, (1 + Nncg::kSweeps) * rows)) {
    nncg_.ForgetAll();
    return false;
  }
  meter_->Begin();
  nncg_.MoveOn(made_, crew_, frame_);
  meter_->Charge(WorkKind::kSweep, Nncg::kSweeps * rows);
  return true;
}

void BlockCycle::See(std::span<const GroupSweeps> groups) {
  const Plan& plan = frame_->plan();
  sweeps_->ErrorsOfIslands(groups, after_);
  for (int i = 0; i < static_cast<int>(islands_.size()); ++i) {
    if (Done(i) || !groups[plan.islands()[i].group].active) continue;
    states_[i].seen = after_[i];
  }
}

void BlockCycle::Judge(bool seen) {
  const Plan& plan = frame_->plan();
  for (int i = 0; i < static_cast<int>(islands_.size()) && seen; ++i) {
    if (!Open(i)) continue;
    if (Largest(states_[i].seen) <= settings_->tuning.min_progress)
      Stop(i, StopReason::kStationary);
  }
  if (seen && settings_->tolerance > 0) JudgeNear();
  for (int i = 0; i < static_cast<int>(islands_.size()); ++i) {
    if (!Open(i)) continue;
    const int sweeps = made_[plan.islands()[i].group].sweeps;
    if (meter_->spent() && sweeps >= LeastSweeps(*settings_)) {
      Stop(i, meter_->stop_reason());
    } else if (sweeps >= MostSweeps(i)) {
      Stop(i, StopReason::kSweepLimit);
    }
  }
  CloseGroups();
}

void BlockCycle::StopLate() {
  for (int i = 0; i < static_cast<int>(islands_.size()); ++i) {
    const int sweeps = made_[frame_->plan().islands()[i].group].sweeps;
    if (Open(i) && sweeps >= LeastSweeps(*settings_)) Stop(i, meter_->stop_reason());
  }
  CloseGroups();
}

void BlockCycle::JudgeNear() {
  // near the solution, the state itself is measured
  const auto near = [this](int i) {
    return Open(i) && Largest(states_[i].seen) <= kNearTolerance * settings_->tolerance;
  };
  ChooseNone();
  bool any = false;
  for (int i = 0; i < static_cast<int>(islands_.size()); ++i) {
    if (!near(i)) continue;
    Choose(i);
    any = true;
  }
  if (!any) return;
  MeasureChosen(&after_);
  for (int i = 0; i < static_cast<int>(islands_.size()); ++i) {
    if (near(i) && Largest(after_[i]) <= settings_->tolerance) Stop(i, StopReason::kConverged);
  }
}

void BlockCycle::KeepBest() {
  // after 1, 2, 4, 8 ... legs: that costs little, and the last one is never far behind
  if (!meter_->limited() || !std::has_single_bit(static_cast<unsigned>(legs_))) return;
  ChooseNone();
  for (int i = 0; i < static_cast<int>(islands_.size()); ++i) {
    if (!Done(i)) Choose(i);
  }
  if (!Active() || meter_->Late(kKeepingSweeps * RowsOf(chosen_))) return;
  sweeps_->MeasureFree(chosen_);
  ReadErrors(&after_);
  for (int i = 0; i < static_cast<int>(islands_.size()); ++i) {
    if (Done(i) || after_[i].energy >= states_[i].best.energy) continue;
    best_.Take(frame_->plan(), i, frame_->blocks());
    states_[i].best = after_[i];
  }
}

void BlockCycle::Finish() {
  const Plan& plan = frame_->plan();
  BlockData* const blocks = &frame_->blocks();
  // islands that were done before others of their group
  for (int i = 0; i < static_cast<int>(islands_.size()); ++i) {
    if (islands_[i].sweeps < made_[plan.islands()[i].group].sweeps) done_.Restore(plan, i, blocks);
  }
  for (GroupSweeps& group : chosen_) group.active = true;
  sweeps_->MeasureFree(chosen_);
  ReadErrors(&after_);

  // sweeps may also make it worse, where friction bounds move: then the best state there was
  for (int i = 0; i < static_cast<int>(islands_.size()); ++i) {
    const bool better = states_[i].best.energy < after_[i].energy;
    if (!better || islands_[i].stop == StopReason::kConverged) continue;
    best_.Restore(plan, i, blocks);
    after_[i] = states_[i].best;
  }
  GuardResult();
}

void BlockCycle::FillReport(Report* report) const {
  const Plan& plan = frame_->plan();
  const std::span<const int> island_of = plan.island_of_body();
  report->island_of.assign(island_of.begin(), island_of.end());
  report->islands.resize(islands_.size());
  for (size_t i = 0; i < islands_.size(); ++i) {
    IslandReport& island = report->islands[i] = islands_[i];
    island.first_body = plan.islands()[i].first_body;
    island.bodies = plan.islands()[i].bodies;
    island.rows = plan.islands()[i].rows;
    island.residual = after_[i];
    island.merit = merits_.of(static_cast<int>(i)).value();
    if (!started_) island.residual_before = island.residual;
  }
}

}  // namespace cairn
