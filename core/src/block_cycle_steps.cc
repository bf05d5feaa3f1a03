// SPDX-License-Identifier: MIT
// Subspace steps of BlockCycle: where, and whether they are kept.
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "block_cycle.h"

namespace cairn {
namespace {

/// Fewer sweeps after a step do not smooth what it leaves behind.
constexpr int kLeastSweepsAfterStep = 3;
/// A step that brought the residual down to this share is kept without trying sweeps alone. Under a
/// budget less is enough: that trial takes from it as much as the sweeps of the step do, and frames
/// are compared there.
constexpr double kSureGain = 0.1, kSureGainOfBudget = 0.7;
/// Squared residuals below this share of the first are rounding.
constexpr double kLeastShare = 1e-10;
/// What costs more sweeps than this is not tried.
constexpr double kMostSweeps = 1000;

}  // namespace

double BlockCycle::SureGain() const { return watches_ ? kSureGainOfBudget : kSureGain; }

void BlockCycle::FindCandidates() {
  const int left = settings_->max_sweeps - SweepsMade();
  if (!steps_.asked() || left < std::min(settings_->k_gs, kLeastSweepsAfterStep)) return;
  // after the step its sweeps, and, where frames are not compared, as many without it
  const double sweeps =
      (watches_ ? 1 : 2) * std::min(settings_->k_gs, left) + 2 * BlockSweeps::kMeasureSweeps;
  const bool always = settings_->step_policy == StepPolicy::kAlways;
  const Plan& plan = frame_->plan();
  double steps_units = 0, sweeps_units = 0;
  for (int g = 0; g < static_cast<int>(made_.size()); ++g) {
    const Group& group = plan.groups()[g];
    const size_t first = stepped_islands_.size();
    for (int i : plan.islands_of_groups().subspan(group.first_island, group.islands)) {
      if (std::exchange(states_[i].rests, false) || Done(i) || states_[i].too_late) continue;
      if (plan.islands()[i].first_body < 0) continue;
      const bool due = steps_.Due(i);
      if (due) stepped_islands_.push_back(i);
      islands_[i].no_step = due ? NoStep::kEnded : NoStep::kPaused;
    }
    if (stepped_islands_.size() == first) continue;

    const double rows = static_cast<double>(group.rows), after = sweeps_units + sweeps * rows;
    const auto islands = std::span(stepped_islands_).subspan(first);
    double price = steps_.PriceOfPrice(g, islands);
    bool fits = meter_->Fits(steps_units + price, after);
    if (fits) {
      // as many factorisations as fit
      int most = settings_->k_sm;
      do {
        price = steps_.Price(g, islands, most);
        fits = (always || price <= kMostSweeps * rows) && meter_->Fits(steps_units + price, after);
      } while (!fits && --most > 0);
      steps_.Limit(g, most);
    }
    if (!fits) {
      // there is never more left of a budget; the next frame has its own
      for (int i : islands) {
        states_[i].too_late = true;
        islands_[i].no_step = NoStep::kTooDear;
        if (!watches_) steps_.Postpone(i);
      }
      stepped_islands_.resize(first);
      continue;
    }
    steps_units += price;
    sweeps_units = after;
  }
}

void BlockCycle::MarkEnergies() {
  for (int i = 0; i < static_cast<int>(islands_.size()); ++i) {
    if (!Done(i)) states_[i].first_energy = states_[i].seen.energy;
  }
}

void BlockCycle::Learn(StepChoice* choice) {
  double first = 0, last = 0;
  for (size_t i = 0; i < islands_.size(); ++i) {
    if (states_[i].first_energy <= 0) continue;
    first += states_[i].first_energy * states_[i].first_energy;
    last += after_[i].energy * after_[i].energy;
  }
  // also where steps were asked for and none was taken: asking took its time
  if (first > 0) choice->Learn(steps_.asked(), -std::log(last / first + kLeastShare));
}

void BlockCycle::TakeSteps() {
  FindCandidates();
  if (stepped_islands_.empty()) return;
  ChooseNone();
  for (int i : stepped_islands_) Choose(i);
  MeasureChosen(&before_);

  // islands of a group follow each other
  const Plan& plan = frame_->plan();
  const std::span<const int> all = stepped_islands_;
  for (size_t begin = 0, end = 0; begin < all.size(); begin = end) {
    const int group = plan.islands()[all[begin]].group;
    while (end < all.size() && plan.islands()[all[end]].group == group) ++end;
    const std::span<const int> islands = all.subspan(begin, end - begin);
    for (int i : islands) before_steps_.Take(plan, i, frame_->blocks());
    steps_.Take(group, islands, meter_);
    for (int i : islands) {
      nncg_.Forget(i);
      islands_[i].factorisations += steps_.result(i).factorisations;
      islands_[i].step_work += static_cast<std::int64_t>(steps_.work(i));
      states_[i].stepped = steps_.result(i).solved;
    }
  }
  std::erase_if(stepped_islands_, [this](int i) {
    if (states_[i].stepped) return false;
    steps_.Judge(i, false);
    ++islands_[i].steps_restored;
    return true;
  });
}

void BlockCycle::KeepBetterSteps(int sweeps) {
  if (stepped_islands_.empty()) return;
  ChooseNone();
  for (int i : stepped_islands_) Choose(i);
  MeasureChosen(&with_step_);
  ChooseNone();
  bool sure = true;
  for (int i : stepped_islands_) {
    states_[i].better_alone = false;
    if (with_step_[i].energy <= SureGain() * before_[i].energy) continue;
    Choose(i);
    sure = false;
  }
  if (!sure) TryWithoutSteps(sweeps);

  for (int i : stepped_islands_) {
    const bool accepted = !states_[i].better_alone;
    if (!accepted) nncg_.Forget(i);
    steps_.Judge(i, accepted);
    ++(accepted ? islands_[i].steps_accepted : islands_[i].steps_restored);
    states_[i].stepped = false;
    states_[i].rests = true;
  }
  stepped_islands_.clear();
}

void BlockCycle::TryWithoutSteps(int sweeps) {
  // the same number of sweeps from before the steps, as far as the budget goes
  const Plan& plan = frame_->plan();
  BlockData* const blocks = &frame_->blocks();
  for (int i = 0; i < static_cast<int>(islands_.size()); ++i) {
    if (!Chosen(i)) continue;
    after_steps_.Take(plan, i, *blocks);
    states_[i].seen_with_step = states_[i].seen;
    if (states_[i].stepped) before_steps_.Restore(plan, i, blocks);
  }
  for (size_t g = 0; g < chosen_.size(); ++g) {
    chosen_[g].sweeps = std::max(0, made_[g].sweeps - sweeps);
  }
  if (sweeps_->Sweep(sweeps, chosen_) && sweeps > 0) See(chosen_);
  MeasureChosen(&alone_);
  for (int i = 0; i < static_cast<int>(islands_.size()); ++i) {
    if (!Chosen(i)) continue;
    states_[i].better_alone = states_[i].stepped && with_step_[i].energy > alone_[i].energy &&
                              with_step_[i].energy > SureGain() * before_[i].energy;
    if (states_[i].better_alone) continue;
    states_[i].seen = states_[i].seen_with_step;
    after_steps_.Restore(plan, i, blocks);
  }
}

}  // namespace cairn
