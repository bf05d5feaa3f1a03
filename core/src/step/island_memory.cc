// SPDX-License-Identifier: MIT
#include "step/island_memory.h"

#include <algorithm>

namespace cairn {
namespace {

/// Opportunities passed over before the price of an island that was too dear is asked again.
constexpr int kPriceAgain = 30;
constexpr int kLongestPause = 32;
constexpr double kMostSoftening = 100;
constexpr double kLeastProximal = 1e-8;
/// By which what a failure taught fades with each success: some 35 of them halve it.
constexpr double kForgetFailures = 0.98;

/// Impulses of joints, see StepResult::joint_speed [m/s], from which on they may be redundant: a
/// chain that carries 1,000 times a link comes to 300, and is asked in vain.
constexpr double kMostJointSpeed = 100;
/// Beyond this floats round by more than 0.6 mm/s, and joints are softened.
constexpr double kTooMuch = 1e4;
/// Where impulses stay below this share of the former for some steps, joints agree.
constexpr double kCalm = 0.1;
/// Steps after which it is asked again whether joints are redundant.
constexpr int kMostJointPause = 3840;
/// What joints are softened to at most where they are redundant, or fling bodies.
constexpr double kMostJointProximal = 1e-3;
constexpr int kMostJointLevel = 4;
/// Opportunities passed over after a guard, the first time.
constexpr int kGuardPause = 8;
constexpr int kMostGuards = 4;
/// After more guards in a row than this, joints are softened, ten times with each: a taut bridge
/// that has opened would else close at once, by being flung sideways, or never again.
constexpr int kLockedOut = 2;
/// Steps kept in a row after which that is taken back by one.
constexpr int kHardenAfter = 8;

/// Ten times softer for each level above 0.
double ProximalOf(double set, int level) {
  double softer = set;
  for (; level > 0; --level) softer *= 10;
  return std::max(set, std::min(softer, kMostJointProximal));
}

}  // namespace

StepSettings IslandMemory::Step(const Settings& settings) const {
  return {
      .proximal = std::clamp(settings.tuning.proximal * softening_, kLeastProximal, 1.0),
      .proximal_joints = ProximalOf(settings.proximal_joints, std::max(joint_level_ - 1, softer_)),
      .factorisations = settings.k_sm,
      .refinements = settings.tuning.refinements,
      .condense_joints = condenses_joints()};
}

bool IslandMemory::Due(const Settings& settings) {
  int* const pause = guard_pause_ > 0 ? &guard_pause_ : &pause_;
  const bool always = settings.step_policy == StepPolicy::kAlways && pause == &pause_;
  if (*pause <= 0 || always) return true;
  --*pause;
  return false;
}

void IslandMemory::EndSolve(bool stepped, bool finished) {
  unfinished_ = !finished;
  stepping_ = stepped ? std::min(stepping_ + kOfStep, kMostStepping) : std::max(stepping_ - 1, 0);
}

void IslandMemory::Postpone() { pause_ = kPriceAgain; }

template <>
BlockSystem<float>& IslandMemory::block_system(simd::Target target) {
  auto& system = systems_.in_floats;
  if (system == nullptr) system = std::make_unique<BlockSystem<float>>(target);
  return *system;
}
template <>
BlockSystem<double>& IslandMemory::block_system(simd::Target target) {
  auto& system = systems_.in_doubles;
  if (system == nullptr) system = std::make_unique<BlockSystem<double>>(target);
  return *system;
}

void IslandMemory::Accepted(double least) {
  strikes_ = guards_ = 0;
  if (softer_ > 0 && ++kept_since_guard_ >= kHardenAfter) {
    --softer_;
    kept_since_guard_ = 0;
  }
  least_ *= kForgetFailures;
  softening_ = std::max({least, least_, softening_ / 2});
}

void IslandMemory::SawJoints(const StepResult& result) {
  if (joint_level_ == 0) {
    if (joint_pause_ > 0) --joint_pause_;
    if (joint_pause_ == 0 && !(result.solved_joint_speed <= kMostJointSpeed)) joint_level_ = 1;
    joints_answered_ = false;
    return;
  }
  joints_answered_ = true;
  const bool redundant = result.joint_speed <= kCondensed * result.solved_joint_speed;
  const bool small = result.solved_joint_speed <= kCalm * kMostJointSpeed;
  calm_steps_ = small ? calm_steps_ + 1 : 0;
  if (!(result.joint_speed <= kTooMuch)) {
    joint_level_ = std::min(kMostJointLevel, joint_level_ + 1);
  } else if (joint_level_ > 1 && calm_steps_ > kLeastJointPause) {
    --joint_level_;
    calm_steps_ = 0;
  } else if ((!redundant && !small) || calm_steps_ > kLeastJointPause) {
    // these joints carry much, or agree by now: asked again later, and ever later
    joint_level_ = calm_steps_ = 0;
    joint_pause_ = joint_pause_next_;
    joint_pause_next_ = std::min(kMostJointPause, 2 * joint_pause_next_);
  }
}

void IslandMemory::Guarded() {
  guard_pause_ = kGuardPause << guards_;
  if (guards_ >= kLockedOut) softer_ = std::min(kMostGuards, softer_ + 1);
  guards_ = std::min(kMostGuards, guards_ + 1);
  kept_since_guard_ = 0;
}

void IslandMemory::Restored() {
  const bool among_many = stepping_ == kMostStepping;
  pause_ = among_many ? 0 : std::min(kLongestPause, 1 << std::min(strikes_, 5));
  ++strikes_;
  softening_ = std::min(kMostSoftening, softening_ * 5);
  least_ = std::min(1.0, softening_);
}

}  // namespace cairn
