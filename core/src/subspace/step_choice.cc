// SPDX-License-Identifier: MIT
#include "subspace/step_choice.h"

#include <algorithm>

namespace cairn {
namespace {

/// Frames to the next trial of the other way: first, and at most.
constexpr int kFirstInterval = 8, kLongestInterval = 256;
/// Weight of the newest frame, and of one that is the first for long.
constexpr double kNewest = 0.3, kTrial = 0.7;

}  // namespace

void StepChoice::Learn(bool stepped, double gain) {
  // nothing is learnt of steps where none could be taken
  if (steps_ != stepped) return;
  Way& way = stepped ? with_ : without_;
  way.gain = way.known ? way.gain + (trial_ ? kTrial : kNewest) * (gain - way.gain) : gain;
  way.known = true;
  ChooseBetter();
}

void StepChoice::ChooseBetter() {
  if (!with_.known || !without_.known) {
    steps_ = !with_.known;
    return;
  }
  const bool better = with_.gain > without_.gain;
  if (trial_) {
    // the other way lost again, or becomes the one to go
    const bool lost = steps_ != better;
    interval_ = lost ? std::min(2 * interval_, kLongestInterval) : kFirstInterval;
    until_trial_ = interval_;
    trial_ = false;
  } else if (interval_ == 0 || steps_ != better) {
    until_trial_ = interval_ = kFirstInterval;
  } else {
    trial_ = --until_trial_ <= 0;
  }
  steps_ = trial_ ? !better : better;
}

}  // namespace cairn
