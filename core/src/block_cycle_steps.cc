// SPDX-License-Identifier: MIT
// Subspace steps of BlockCycle: where, and whether they are kept.
#include <algorithm>
#include <utility>

#include "block_cycle.h"

namespace cairn {
namespace {

/// Fewer sweeps after a step do not smooth what it leaves behind.
constexpr int kLeastSweepsAfterStep = 3;
/// A step that brought the residual down to this share is kept without trying sweeps alone.
constexpr double kSureGain = 0.1;

}  // namespace

void BlockCycle::FindCandidates() {
  const int left = settings_->max_sweeps - SweepsMade();
  if (left < std::min(settings_->k_gs, kLeastSweepsAfterStep)) return;
  // after the step, its sweeps, and as many without it, which it has to beat
  const double sweeps = 2 * (std::min(settings_->k_gs, left) + BlockSweeps::kMeasureSweeps);
  const Plan& plan = frame_->plan();
  for (int i = 0; i < static_cast<int>(islands_.size()); ++i) {
    if (std::exchange(states_[i].rests, false) || Done(i)) continue;
    if (steps_.Pays(i, meter_, sweeps * plan.islands()[i].rows)) stepped_islands_.push_back(i);
  }
}

void BlockCycle::TakeSteps() {
  FindCandidates();
  if (stepped_islands_.empty()) return;
  ChooseNone();
  for (int i : stepped_islands_) Choose(i);
  MeasureChosen(&before_);
  std::erase_if(stepped_islands_, [this](int i) {
    before_steps_.Take(frame_->plan(), i, frame_->blocks());
    const int factorisations = steps_.Take(i, meter_);
    islands_[i].factorisations += factorisations;
    states_[i].stepped = factorisations > 0;
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
    if (with_step_[i].energy <= kSureGain * before_[i].energy) continue;
    Choose(i);
    sure = false;
  }
  if (!sure) TryWithoutSteps(sweeps);

  for (int i : stepped_islands_) {
    const bool accepted = !states_[i].better_alone;
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
                              with_step_[i].energy > kSureGain * before_[i].energy;
    if (states_[i].better_alone) continue;
    states_[i].seen = states_[i].seen_with_step;
    after_steps_.Restore(plan, i, blocks);
  }
}

}  // namespace cairn
