// SPDX-License-Identifier: MIT
#pragma once

namespace cairn {

/// Whether steps or sweeps alone make more of a budget: both are tried, a frame each, and the one
/// that gains more goes on. The loser is tried again after a while, and ever more rarely while it
/// goes on to lose.
class StepChoice {
 public:
  /// For the next frame.
  bool steps() const { return steps_; }
  /// What a frame came to, with steps or without. @p gain: comparable between frames
  void Learn(bool stepped, double gain);

 private:
  struct Way {
    double gain = 0;  ///< mean that forgets
    bool known = false;
  };
  void ChooseBetter();

  Way with_, without_;
  bool steps_ = true;
  bool trial_ = false;  ///< the next frame goes the way that lost last
  int until_trial_ = 0, interval_ = 0;
};

}  // namespace cairn
