// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "cairn/detail/memory.h"
#include "cairn/settings.h"
#include "step/block_system.h"
#include "step/step_odds.h"
#include "step/step_settings.h"

namespace cairn {

class BodySystem;

/// Of a factorisation: multiply-adds, entries of the factor, and bodies, 0 if there was none.
struct FactorSize {
  double flops = 0, nonzeros = 0, bodies = 0;
};

/// What the solver remembers of an island from frame to frame: the analysed system, the proximal
/// term that worked, and whether steps pay. A copy knows all but the system.
class IslandMemory : public detail::Placed {
 public:
  StepSettings Step(const Settings& settings) const;

  /// Whether no step failed here of late: one opportunity less to be passed over, if not.
  bool Due(const Settings& settings);
  /// Steps are too dear here: to be asked again after a while.
  void Postpone();
  /// How far the proximal term falls where steps succeed, relative to what is set: with ten sweeps
  /// around every step, what is smaller excites contacts that come and go.
  static constexpr double kLeastSoftening = 1.0 / 4;
  /// @param least  factor on Tuning::proximal that successes bring it down to, > 0
  void Accepted(double least = kLeastSoftening);
  /// A step was undone: the next ones are passed over, more each time. The first one among many
  /// that were kept is tried again at once: sweeps alone would let go what those held.
  void Restored();
  /// A guard undid something here: sweeps only for a while, longer each time that it happens again.
  /// From the third in a row on joints are softened, too, until some steps were kept.
  void Guarded();
  /// How large impulses of joints were in a step. Where they are larger than floats can hold
  /// against each other, joints are redundant, and are condensed from then on; where that is not
  /// enough, softened, too.
  void SawJoints(const StepResult& result);
  bool condenses_joints() const { return joint_level_ > 0; }
  /// Condensing costs a factorisation more in each step. The first one only asks whether joints are
  /// redundant, every 60 steps or less often: an island that has no room for it is to ask anyway,
  /// or it would never get a step again.
  bool pays_for_condensing() const { return condenses_joints() && joints_answered_; }

  /// The last Solve() left the island unfinished, and steps are rare: what accelerated sweeps add
  /// to the impulses of the start then comes late, and goes too far.
  bool overshoots() const { return unfinished_ && stepping_ <= kOfStep; }
  /// A step was kept in one of the last Solve()s.
  bool stepped_of_late() const { return stepping_ > 0; }
  /// @param stepped   a step was kept
  /// @param finished  sweeps did not end at their limit
  void EndSolve(bool stepped, bool finished);

  /// The last factor that was priced here.
  const FactorSize& factor_size() const { return factor_size_; }
  void Remember(const FactorSize& size) { factor_size_ = size; }

  /// Of blocks under a budget: what steps and sweeps gain here.
  StepOdds& odds() { return odds_; }

  /// Of the double-precision path, which makes it.
  std::shared_ptr<BodySystem>& body_system() { return systems_.of_rows; }
  /// For steps on blocks: of the group whose first island this is.
  template <class T>
  BlockSystem<T>& block_system(simd::Target target);

 private:
  static constexpr int kLeastJointPause = 60;
  /// A step counts for so many frames without one, and all of late for at most so many.
  static constexpr int kOfStep = 8, kMostStepping = 60;

  /// Analysed graphs: a copy begins without.
  struct Systems {
    Systems() = default;
    Systems(const Systems&) {}
    Systems& operator=(const Systems&) = delete;

    std::shared_ptr<BodySystem> of_rows;
    std::unique_ptr<BlockSystem<float>> in_floats;
    std::unique_ptr<BlockSystem<double>> in_doubles;
  };

  Systems systems_;
  StepOdds odds_;
  double softening_ = 1;  ///< factor on Tuning::proximal
  double least_ = 0;      ///< what it does not fall below, since smaller ones failed; <= 1
  FactorSize factor_size_;
  int strikes_ = 0;                   ///< rejections in a row
  int pause_ = 0;                     ///< opportunities still to be passed over
  int guards_ = 0, guard_pause_ = 0;  ///< how often of late, and likewise after one
  /// How much softer joints are since guards undid several steps in a row, and steps kept since.
  int softer_ = 0, kept_since_guard_ = 0;
  /// How much is done about redundant joints, steps in a row without need for it, and steps until
  /// they are looked at again.
  int joint_level_ = 0, calm_steps_ = 0, joint_pause_ = 0, joint_pause_next_ = kLeastJointPause;
  bool unfinished_ = false;       ///< when the last Solve() ended
  int stepping_ = 0;              ///< 0 where there were no steps of late, kMostStepping: many
  bool joints_answered_ = false;  ///< a step has condensed them since the level was 0
};

}  // namespace cairn
