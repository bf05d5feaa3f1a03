// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace cairn {

/// What sweeps and steps were seen to do to the residual in energy of an island, and so whether a
/// step pays under a budget. k sweeps bring the residual down to a power of 1 / k: the first ones
/// do most. A step brings it down once, and the sweeps after it go on as if there had been none; so
/// it costs what the last ones would have done, for which the budget does not suffice any more.
class StepOdds {
 public:
  /// Islands of so many bodies are small: steps there take microseconds.
  static constexpr int kFewBodies = 20;
  /// And of so many tiny: all else there takes longer than the sweeps of sequential impulses.
  static constexpr int kFewestBodies = 5;
  /// After so many frames of sweeps alone, over so many steps joints come to take back all of their
  /// errors. Loads that fall do not wait: steps that pause for a frame or two go on as before.
  static constexpr int kEased = 8;
  /// Islands by how many bodies they have; kMany, too, where there are joints.
  enum class Size { kMany, kFew, kFewest };

  /// How many times the price of a step has to be left of the budget for it to pay, if the sweeps
  /// that were made before it are added to what is left; infinite if it never does.
  /// @param gain  cut() / power()
  static double PricesLeft(double gain);

  /// The power of sweeps alone that brought the residual down to this share, infinite if nothing is
  /// left, or was. @p from, @p to: how many there were since the frame or a step began
  static double PowerOf(int from, int to, double share);
  void LearnSweeps(double power);
  /// A step and the sweeps that smooth it did. @p steps: before it in the frame
  void LearnStep(int steps, double share);
  /// By how much a step and the sweeps after it, and as many sweeps alone, brought the island
  /// closer in energy [J]: residuals say little of that after a step, which leaves them rough.
  /// @param needed  steps are taken there anyway: those that follow go on with them
  void LearnGains(double with_step, double alone, Size size = Size::kMany, bool needed = false);
  /// Without a budget: a step brings phi down by more than so many times what the sweeps in its
  /// place do, or that is not known yet.
  bool pays() const { return pays_; }
  /// There was one in the last kLate frames.
  bool stepped_of_late() const { return frames_without_ < kLate; }
  /// There was one in the last frame, of an island of not many fewer bodies: others may have been
  /// left to sweeps before they joined it.
  bool stepped_most(int bodies) const {
    return 4 * static_cast<std::int64_t>(bodies) <= 5 * static_cast<std::int64_t>(stepped_bodies_);
  }
  /// How much of the errors of joints the next step is to take back, in (0, 1]: an nth more in each
  /// of the first n steps, see kEased. All of it where an island is young.
  double share() const;
  /// The next step finds out whether steps pay, with all that targets ask for, and is not kept: it
  /// would take back all errors at once.
  bool only_looks() const { return eased_frames_ == 0 && wants_trial(); }
  /// Ends a frame for share(). @p kept: a step was
  void EndSteps(bool kept);
  /// Whether a step pays is not known, or was not looked at for a while.
  bool wants_trial() const { return trial_age_ >= trial_pause_; }
  /// The last time that both were tried, sweeps came nowhere near: one step is worth its price.
  bool carries() const { return carries_; }
  /// What the first step of a frame is thought to do before one was measured.
  void Expect(double cut);
  /// Where no step was taken, what is known of them fades into what was expected.
  /// @param stepped_bodies  of the island, 0 where no step was taken
  /// @param error  that it ended with [m/s] or [rad/s]
  /// @param time_step  of the frame [s], 0: unknown
  void EndFrame(int stepped_bodies, double error = 0, double time_step = 0);
  /// The last frames that had sweeps alone ended with gross errors: what hits something is soon
  /// done with it, a load that sweeps do not carry is not.
  bool stays_gross() const { return gross_frames_ >= kGrossFrames; }
  /// The last half a second ended with errors that one sees: what rests goes on rocking.
  bool stays_rough() const { return rough_frames_ >= kRoughFrames; }
  /// No frame of the island has ended.
  bool is_new() const { return frames_ == 0; }
  /// A few have, and what was learnt in them says little: of what wakes up, gravity is on some
  /// bodies alone in the first one.
  bool is_young() const { return frames_ < kYoung; }
  /// Sweeps were not measured for long: a frame without steps is due.
  bool stale() const;

  double power() const { return power_; }
  /// What a step surely does, as a logarithm; less than 0 where it does harm.
  double cut(int steps) const { return (steps == 0 ? first_.cut : later_.cut) - kMargin; }

 private:
  /// Of steps: logarithm of the residual before over that after, mean that forgets.
  struct Cut {
    double cut = 0;
    bool known = false;
  };

  /// Sweeps after a step build on each other anew, and gain less at first than those in its place.
  static constexpr double kMargin = 0.4;
  /// What is measured on rubble; a step that is tried in vain costs more than one that is not
  /// tried.
  static constexpr double kExpectedPower = 2;

  static constexpr double kCarries = 2;

  static constexpr int kLate = 60;
  static constexpr int kGrossFrames = 4, kRoughFrames = 30;
  static constexpr int kYoung = 8;

  int frames_ = 0;  ///< that have ended, at most kYoung
  bool carries_ = false;
  bool pays_ = true;
  int stepped_bodies_ = 0, frames_without_ = kLate;
  int plain_frames_ = 0;       ///< in a row in which no step was kept; at most kEased
  int eased_frames_ = kEased;  ///< in which one was since kEased plain ones; at most kEased
  /// In a row, of those without a step; at most kGrossFrames and kRoughFrames.
  int gross_frames_ = 0, rough_frames_ = 0;
  /// Logarithm of the gain of steps over that of the sweeps in their place: mean that forgets.
  double ratio_ = 0;
  int trials_ = 0;                       ///< that it is of
  int trial_age_ = 0, trial_pause_ = 0;  ///< frames since both were tried, and until they are again
  double pace_ = 1;  ///< so many times shorter than 1/60 s the last frame was, or 1
  double power_ = kExpectedPower;
  bool power_known_ = false;
  int age_ = 0;  ///< frames since the power was measured
  double expected_ = 0;
  Cut first_, later_;
};

}  // namespace cairn
