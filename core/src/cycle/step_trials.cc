// SPDX-License-Identifier: MIT
#include "cycle/step_trials.h"

#include <algorithm>

namespace cairn {
namespace {

/// A step that brought the residual down to this share, and phi down, is kept without trying sweeps
/// alone: that trial costs as much as the sweeps of the step do.
constexpr double kSureGain = 0.5;
/// What measuring a step and undoing it costs, in sweeps.
constexpr double kJudgingSweeps = 2;

}  // namespace

void StepTrials::Begin(const CycleFrame& frame, const Parts& parts) {
  frame_ = &frame;
  parts_ = parts;
  chosen_.Begin(frame.plan());
  stepped_.clear();
  verdicts_.assign(frame.plan().islands().size(), Verdict::kKept);
  manners_.assign(frame.plan().islands().size(), Manner::kWhole);
}

void StepTrials::Choose(std::span<const int> islands) {
  chosen_.Clear();
  for (int i : islands) chosen_.Add(i);
}

void StepTrials::Measure(Array<Residual>* residuals) {
  const size_t islands = frame_->plan().islands().size();
  if (residuals->size() < islands) residuals->resize(islands);
  parts_.sweeps->Measure(chosen_.groups());
  parts_.sweeps->ErrorsOfIslands(chosen_.groups(), *residuals);
}

void StepTrials::SetJudgingAside() { frame_->meter->SetAside(kJudgingSweeps * chosen_.Rows()); }

void StepTrials::Take(std::span<const int> islands) {
  if (islands.empty()) return;
  stepped_.assign(islands.begin(), islands.end());
  Choose(stepped_);
  Ease();
  if (IsGuarded(frame_->settings)) parts_.steps->FindBefore();
  Measure(&before_);
  merits_before_.Find(frame_->blocks, chosen_.groups());
  SetJudgingAside();

  const std::span<const int> all = stepped_;
  for (size_t begin = 0, end = 0; begin < all.size(); begin = end) {
    const int group = frame_->plan().islands()[all[begin]].group;
    while (end < all.size() && frame_->plan().islands()[all[end]].group == group) ++end;
    TakeOfGroup(group, all.subspan(begin, end - begin));
  }
  std::erase_if(stepped_, [this](int i) { return !(*parts_.islands)[i].stepped(); });
  if (!stepped_.empty()) return;
  frame_->meter->SetAside(0);
  eased_.GiveBack(frame_->data());
}

void StepTrials::Ease() {
  for (int i : stepped_) {
    const StepOdds& odds = parts_.steps->odds(i);
    const bool eases = frame_->weighs_steps() && parts_.steps->HasJoints(i);
    manners_[i] = !eases                ? Manner::kWhole
                  : odds.only_looks()   ? Manner::kLooks
                  : !(odds.share() < 1) ? Manner::kWhole
                                        : Manner::kEased;
    if (manners_[i] == Manner::kEased) eased_.Ease(*frame_, i, odds.share());
  }
}

void StepTrials::EndEasing() {
  if (!eased_.any()) return;
  eased_.GiveBack(frame_->data());
  Choose(stepped_);
  Measure(&alone_);
  for (int i : stepped_) {
    if (manners_[i] == Manner::kEased) (*parts_.islands)[i].seen = alone_[i];
  }
}

void StepTrials::TakeOfGroup(int group, std::span<const int> islands) {
  BlockSteps& steps = *parts_.steps;
  const Plan& plan = frame_->plan();
  if (GoesOnAlone()) {
    // in the lanes of all who share them
    for (int i : plan.islands_in(plan.groups()[group]))
      before_steps_.Take(plan, i, *frame_->data());
    parts_.nncg->Keep(plan, plan.groups()[group]);
  } else {
    for (int i : islands) before_steps_.Take(plan, i, *frame_->data());
  }
  steps.Take(group, islands);
  for (int i : islands) {
    parts_.nncg->Forget(i);
    IslandProgress& island = (*parts_.islands)[i];
    IslandReport& report = parts_.islands->report(i);
    report.factorisations += steps.result(i).factorisations;
    report.step_work += static_cast<std::int64_t>(steps.work(i));
    if (steps.result(i).solved) {
      island.Step();
    } else if (steps.given_up(i)) {
      island.EndSteps();
      report.no_step = NoStep::kTooDear;
    } else {
      steps.Judge(i, false);
      ++report.steps_restored;
    }
  }
}

bool StepTrials::Begins(int i) {
  return parts_.steps->HasJoints(i) && !parts_.steps->stepped_of_late(i);
}

bool StepTrials::IsSure(int i) {
  if (frame_->weighs_steps() && parts_.steps->odds(i).wants_trial()) return false;
  return with_step_[i].energy <= kSureGain * before_[i].energy && GainOfStep(i) >= 0;
}

double StepTrials::GainOfStep(int i) const {
  return merits_before_.of(i).value() - merits_with_step_.of(i).value();
}

double StepTrials::GainAlone(int i) const {
  return merits_before_.of(i).value() - merits_alone_.of(i).value();
}

bool StepTrials::IsBetterAlone(int i) {
  if (IsSure(i)) return false;
  const StepTrial trial{.with_step = with_step_[i].energy,
                        .alone = alone_[i].energy,
                        .lead = GainOfStep(i) - GainAlone(i),
                        .begins = Begins(i),
                        .strained = parts_.steps->IsStrained(i)};
  return trial.is_better_alone();
}

bool StepTrials::IsFlung(int i, double error) const {
  const BlockSteps& steps = *parts_.steps;
  const double mass = steps.mass(i);
  if (!cairn::IsFlung(steps.before(i), steps.after(i), mass, error)) return false;
  // what a hook or a platform does, too, bodies may have taken over
  const double driven = steps.SpeedOfUnmoved(i);
  const IslandMotion with_it{driven, 0.5 * mass * driven * driven};
  return cairn::IsFlung(LargerOf(steps.before(i), with_it), steps.after(i), mass, error);
}

bool StepTrials::Catches(int i) const {
  const BlockSteps& steps = *parts_.steps;
  return steps.IsStrained(i) &&
         !IsFaster(steps.before(i), steps.SpinEnergy(i, 0), steps.after(i), steps.SpinEnergy(i, 1));
}

void StepTrials::FindHarm() {
  merits_with_step_.Find(frame_->blocks, chosen_.groups());
  for (int i : stepped_) verdicts_[i] = Verdict::kKept;
  if (!IsGuarded(frame_->settings)) return;
  BlockSteps& steps = *parts_.steps;
  steps.FindAfter();
  const double unit = UnitOf(frame_->settings);
  for (int i : stepped_) {
    const Merit &before = merits_before_.of(i), &after = merits_with_step_.of(i);
    double error = unit * Largest(before_[i], unit);
    // sweeps from nothing soon leave small errors, and much before them
    if (Begins(i)) {
      error = std::max(error, unit * Largest(parts_.islands->report(i).residual_before, unit));
    }
    const bool squeezed =
        !steps.HasJoints(i) && IsSqueezed({before_[i].energy, with_step_[i].energy, before, after});
    const bool thrown = IsTooViolent(before, after, steps.mass(i), error) && !Catches(i);
    const bool harmful = squeezed || after.is_worse_than_none() ||
                         IsTooMuch(steps.result(i).joint_speed) || thrown || IsFlung(i, error);
    if (harmful) verdicts_[i] = Verdict::kHarmful;
  }
}

void StepTrials::Judge(int sweeps) {
  if (!pending()) return;
  Choose(stepped_);
  frame_->meter->SetAside(0);
  Measure(&with_step_);
  FindHarm();
  chosen_.Clear();
  bool sure = true;
  for (int i : stepped_) {
    if (verdicts_[i] == Verdict::kKept && IsSure(i)) continue;
    chosen_.Add(i);
    sure = false;
  }
  if (!sure && frame_->meter->out_of_time()) {
    CompareWithBefore();
  } else if (!sure) {
    TryAlone(sweeps);
  }
  EndEasing();
  for (int i : stepped_) Note(i, sweeps);
  stepped_.clear();
}

void StepTrials::Note(int i, int sweeps) {
  BlockSteps& steps = *parts_.steps;
  CycleIslands& islands = *parts_.islands;
  IslandReport& report = islands.report(i);
  const bool accepted = verdicts_[i] == Verdict::kKept;
  if (frame_->watches_gains() && sweeps >= kLeastSweepsAfterStep && before_[i].energy > 0) {
    steps.odds(i).LearnStep(islands.StepsTaken(i), with_step_[i].energy / before_[i].energy);
  }
  if (accepted) {
    islands[i].run.Begin(islands.SweepsMade() - sweeps, islands.SweepsMade(),
                         islands[i].seen.energy);
  }
  if (verdicts_[i] == Verdict::kHarmful) {
    report.guards.step = true;
    steps.Guarded(i);
  }
  if (verdicts_[i] != Verdict::kSeen) steps.Judge(i, accepted);
  ++(accepted ? report.steps_accepted : report.steps_restored);
  islands[i].Judge();
}

void StepTrials::LearnGains(int i) {
  BlockSteps& steps = *parts_.steps;
  StepOdds& odds = steps.odds(i);
  // a part of the errors says nothing of what all of them take
  if (manners_[i] == Manner::kEased) return;
  const bool paid = odds.pays();
  const bool needed = steps.IsNeeded(i);
  odds.LearnGains(GainOfStep(i), GainAlone(i), steps.SizeOf(i), needed);
  if (!frame_->weighs_steps() || verdicts_[i] != Verdict::kKept) return;
  const bool goes_on = paid || odds.pays() || needed;
  if (!goes_on) verdicts_[i] = Verdict::kBetterAlone;
  if (goes_on && manners_[i] == Manner::kLooks) verdicts_[i] = Verdict::kSeen;
}

void StepTrials::CompareWithBefore() {
  for (int i : stepped_) {
    if (!chosen_.Has(i)) continue;
    const StepTrial trial{
        .with_step = with_step_[i].energy, .alone = before_[i].energy, .lead = GainOfStep(i)};
    if (verdicts_[i] == Verdict::kKept && !IsSure(i) && trial.is_better_alone()) {
      verdicts_[i] = Verdict::kBetterAlone;
    }
    if (verdicts_[i] == Verdict::kKept) continue;
    before_steps_.Restore(frame_->plan(), i, frame_->data());
  }
  for (int i : stepped_) parts_.nncg->Forget(i);
}

void StepTrials::TryAlone(int sweeps) {
  // the same number of sweeps from before the steps, as far as the budget goes
  const Plan& plan = frame_->plan();
  CycleIslands& islands = *parts_.islands;
  if (seen_with_step_.size() < plan.islands().size()) seen_with_step_.resize(plan.islands().size());
  for (int i = 0; i < islands.count(); ++i) {
    if (!chosen_.Has(i)) continue;
    after_steps_.Take(plan, i, *frame_->data());
    seen_with_step_[i] = islands[i].seen;
    if (islands[i].stepped()) before_steps_.Restore(plan, i, frame_->data());
  }
  RewindSweeps(sweeps);
  SetJudgingAside();
  if (parts_.sweeps->Sweep(sweeps, chosen_.groups()) && sweeps > 0) {
    islands.See(chosen_.groups(), parts_.sweeps);
  }
  frame_->meter->SetAside(0);
  Measure(&alone_);
  merits_alone_.Find(frame_->blocks, chosen_.groups());
  for (int i = 0; i < islands.count(); ++i) {
    if (!chosen_.Has(i)) continue;
    if (islands[i].stepped()) {
      if (verdicts_[i] == Verdict::kKept && IsBetterAlone(i)) verdicts_[i] = Verdict::kBetterAlone;
      if (frame_->learns()) LearnGains(i);
      if (verdicts_[i] != Verdict::kKept) continue;
    }
    KeepAsAfterSteps(i);
  }
  if (GoesOnAlone()) return GoOnAlone(sweeps);
  for (int i : stepped_) parts_.nncg->Forget(i);
}

bool StepTrials::GoesOnAlone() const { return frame_->accelerates() && !frame_->meter->limited(); }

void StepTrials::GoOnAlone(int sweeps) {
  const Plan& plan = frame_->plan();
  CycleIslands& islands = *parts_.islands;
  chosen_.Clear();
  for (int i : stepped_) {
    if (verdicts_[i] != Verdict::kKept) chosen_.Add(i);
  }
  for (int i = 0; i < islands.count(); ++i) {
    if (chosen_.Has(i)) before_steps_.Restore(plan, i, frame_->data());
  }
  for (size_t g = 0; g < chosen_.groups().size(); ++g) {
    if (chosen_.groups()[g].active) parts_.nncg->GoBack(plan, plan.groups()[g]);
  }
  RewindSweeps(sweeps);
  parts_.cycle_sweeps->Sweep(sweeps, chosen_.groups(), CycleSweeps::Steps::kUndone);
  for (int i = 0; i < islands.count(); ++i) {
    const bool stepped = islands[i].stepped(), kept = verdicts_[i] == Verdict::kKept;
    if (stepped && kept) parts_.nncg->Forget(i);
    if (chosen_.Has(i) && !(stepped && !kept)) KeepAsAfterSteps(i);
  }
}

void StepTrials::RewindSweeps(int sweeps) {
  for (size_t g = 0; g < chosen_.groups().size(); ++g) {
    chosen_.groups()[g].sweeps = std::max(0, parts_.islands->groups()[g].sweeps - sweeps);
  }
}

void StepTrials::KeepAsAfterSteps(int island) {
  (*parts_.islands)[island].seen = seen_with_step_[island];
  after_steps_.Restore(frame_->plan(), island, frame_->data());
}

}  // namespace cairn
