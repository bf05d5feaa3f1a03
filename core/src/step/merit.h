// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "cairn/detail/memory.h"
#include "cairn/settings.h"
#include "pack/block_frame.h"
#include "sweep/block_sweep.h"

namespace cairn {

/// What the problem minimises over the impulses inside their bounds, with those of friction frozen:
///
///     phi(x) = 1/2 |u|^2 + 1/2 x'E x - b'x,   u = G'x,   b = target - J v_free,
///
/// 0 without impulses. 1/2 |v_free + M^-1 J'x|^2_M, the kinetic energy after the step, is
/// phi(x) + target'x - 1/2 x'E x more than before. So what is not above 0 puts in no more energy
/// than its targets do; docs/solver.md derives a bound from the problem alone.
struct Merit {
  double square = 0;        ///< |u|^2 + x'E x [J]
  double gain = 0;          ///< b'x [J]
  bool may_be_none = true;  ///< impulses of 0 are inside their bounds

  double value() const { return square / 2 - gain; }
  /// The impulses put in energy that nothing asks for: none at all would be better. Every state
  /// that sweeps come to from none passes, and every solution by far.
  bool is_worse_than_none() const;
  /// Factor in [0, 1] on all impulses that brings phi to its least.
  double best_scale() const;
};

/// What a step and the sweeps after it made of an island, and as many sweeps alone.
struct StepTrial {
  double with_step, alone;  ///< Residual::energy
  double lead;              ///< By how much phi is lower with the step [J]; above 0 it is closer.
  bool begins = false;      ///< The island has joints, and had no step of late.
  bool strained = false;    ///< Joints of it pull hard: BlockSteps::IsStrained().

  /// Residuals see how rough a step leaves an island, and not how far it is from its solution. They
  /// decide where phi cannot: redundant rows that contradict each other lower it the larger they
  /// get. What is not a number is not kept. Sweeps that begin from nothing soon leave small
  /// residuals, and a taut bridge that falls as a whole, and so do those of a bridge under strain:
  /// there the lead of a step is far more than what is rough could take back. A step that falls
  /// that far behind where it begins throws such a bridge.
  bool is_better_alone() const {
    const bool far_behind = begins && -lead > kFarAhead * alone * alone;
    if (far_behind) return true;
    const bool far_ahead = (begins || strained) && lead > kFarAhead * with_step * with_step;
    const bool closer = lead > 0 && (with_step <= kMostRoughness * alone || far_ahead);
    return !(with_step <= alone) && !closer;
  }
  static constexpr double kMostRoughness = 4, kFarAhead = 16;
};

/// Impulses of joints, see StepResult::joint_speed, that no step may leave: floats round them by
/// 6 cm/s.
inline bool IsTooMuch(double joint_speed) { return !(joint_speed <= 1e6); }

/// Whether a step changed velocities beyond what errors call for: rows that were let go for long
/// contradict each other by little over arms that are short, and what meets them at once throws
/// bodies. It is by 1,000 times the energy of an island of that @p mass [kg] that moves at the
/// largest @p error before the step, [m/s] or [rad/s]; the usual is 1. And the step did most of all
/// that the impulses do: what is small beside them may have any ratio to an error that is smaller.
bool IsTooViolent(const Merit& before, const Merit& after, double mass, double error);

/// What a step and the sweeps after it did to an island: Residual::energy, and what phi is made of.
struct StepEffect {
  double error_before, error_after;
  const Merit &before, &after;
};

/// Whether a step only set impulses against each other. What is squeezed harder than there is room
/// has rows that contradict each other: phi falls the larger they get, and velocities are what is
/// left of sums that cancel. At a solution gain and square are the same, but for what slides.
/// Joints are often redundant, and their steps look like that: for islands without joints.
inline bool IsSqueezed(const StepEffect& step) {
  return step.after.gain > 8 * step.after.square && step.after.gain > step.before.gain &&
         step.error_after > 0.5 * step.error_before;
}

/// How an island moves along, turning aside.
struct IslandMotion {
  double speed = 0;   ///< of its fastest body [m/s]
  double energy = 0;  ///< 1/2 m v^2 of all [J]
};

inline IslandMotion LargerOf(const IslandMotion& a, const IslandMotion& b) {
  return {std::max(a.speed, b.speed), std::max(a.energy, b.energy)};
}

/// Bodies are faster by a quarter, or have as much more energy, that of their spins included. A
/// step on a taut bridge that sags may do far more than errors call for, since sweeps leave small
/// errors there, far from the solution. Where bodies are no faster it caught the bridge, and threw
/// nothing.
/// @param spin_before, spin_after  energy of spins [J], before without impulses
inline bool IsFaster(const IslandMotion& before, double spin_before, const IslandMotion& after,
                     double spin_after) {
  constexpr double kMuch = 1.25;
  const bool calm = after.speed <= kMuch * before.speed &&
                    after.energy + spin_after <= kMuch * (before.energy + spin_before);
  return !calm;
}

/// Whether a step flung bodies off. @p before: the island without impulses, or with those before
/// the step, whichever is more. Bodies pass on speed and energy, and rows ask for the largest @p
/// error before the step besides. More than twice the sum of both is too much: of 300,000 steps in
/// random worlds the energies of 30 were.
inline bool IsFlung(const IslandMotion& before, const IslandMotion& after, double mass,
                    double error) {
  return after.speed > 2 * (before.speed + error) ||
         after.energy > 2 * (before.energy + 0.5 * mass * error * error);
}

/// Whether impulses are guarded at all. Plain methods are what their names say, who asks for no
/// sweeps wants the start, and friction that is held is no minimum of anything.
bool IsGuarded(const Settings& settings);

/// Of an island without joints.
inline constexpr int kGuardedSweep = 3;

/// Sweeps after which the start of an island is judged. Where a point of contact was lost with what
/// it carried, the rest of a good start is worth less than none, and a sweep mends most of that:
/// scaled down at once, a tower would lose all of its warm start. But sweeps smooth a rotten start,
/// too, before it is seen, and trees and hubs of joints grow wild by what that lets through.
inline int GuardedSweep(bool joints) { return joints ? 1 : kGuardedSweep; }

/// Merits of islands in blocks, the same for an island whatever shares its lanes.
class IslandMerits {
 public:
  /// Of the islands of active groups; others keep theirs.
  void Find(BlockFrame* frame, std::span<const GroupSweeps> groups);
  const Merit& of(int island) const { return merits_[island]; }

 private:
  /// Of blocks of a unit, into gains_ and squares_.
  void FindOfUnit(BlockFrame* frame, const Unit& unit);
  void FindOfGroup(BlockFrame* frame, const Group& group);
  // Sums of numbers that do not depend on their order: of a group of one island, and of several.
  void AddWhole(const simd::LaneKernels& kernels, const Group& group, int island);
  void AddShared(const Plan& plan, const Group& group);
  /// Where squares of a group are.
  double* SquaresOf(const Group& group);

  Array<Merit> merits_;
  Array<double> scales_;  ///< bring the largest square of a sum to so many bits, by island
  /// By lane of all blocks; group by group, squares by lane and then those of bodies.
  Array<double> gains_, squares_;
  struct OfBlock {
    std::uint32_t without_zero = 0;  ///< lanes of rows that cannot be 0
    bool soft = false;               ///< squares of its lanes may be above 0
  };
  Array<OfBlock> of_blocks_;
};

/// Sets the factors of islands to 1 that have a row which cannot be 0: scaled, it could leave its
/// bounds, and no sweep brings back a row that its host leaves out of sweeps.
void LeaveForced(const Plan& plan, const BlockData& blocks, std::span<float> factors);

/// Multiplies impulses and velocity changes of each island by its factor; 0 leaves nothing of what
/// is not finite. @pre islands with a row that cannot be 0 have factor 1
void ScaleIslands(const Plan& plan, std::span<const float> factors, BlockData* blocks);

}  // namespace cairn
