// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <span>

#include "cairn/detail/memory.h"
#include "pack/block_frame.h"
#include "runtime/crew.h"
#include "sweep/block_sweep.h"

namespace cairn {

/// Nonsmooth nonlinear conjugate gradients over sweeps (Silcowitz-Niebe and Erleben 2010): before a
/// sweep the state is moved on along what the last ones changed, by the ratio of squared steps that
/// Fletcher and Reeves give; where steps grow, an island starts anew. Other than there and in
/// Bullet, steps are measured in energy, so that light bodies do not drown among heavy ones, and
/// what is moved out of its bounds is brought back by the sweep that has to follow.
///
/// An island also starts anew where a sweep goes back on its direction: it was moved too far. With
/// a ratio beta, errors shrink by sqrt(beta) a sweep and no faster, and that gives beta again: what
/// began with a bad ratio would keep it, however fast sweeps alone are (O'Donoghue, Candes 2015,
/// *Adaptive restart for accelerated gradient schemes*; there the product is with the gradient).
///
/// u is moved along with the impulses, which costs no product with G.
class Nncg {
 public:
  /// What moving on costs, in sweeps.
  static constexpr double kSweeps = 0.3;

  /// A frame that has begun.
  void Begin(const BlockFrame& frame);
  /// The state of an island was changed by something else: it has no direction.
  void Forget(int island);
  /// Likewise islands of a group with rows that take part in so many sweeps and no more: they are
  /// not to be moved, as no sweep would bring them back into their bounds.
  void ForgetWhereRowsEnd(int group, int sweeps);
  void ForgetAll();
  /// Keeps the directions of a group, until the next Keep() of it.
  void Keep(const Plan& plan, const Group& group);
  /// Its islands go on along those that were kept.
  void GoBack(const Plan& plan, const Group& group);
  /// What the last sweep changed on an island [sqrt(J)], see Residual::energy.
  void See(int island, double energy);
  /// Whether no state of this frame was known, and this one is the first: it has no direction yet.
  bool StartsFrom(const BlockData& now, Crew* crew);
  /// Moves the state of the active groups on. A whole sweep has to follow.
  void MoveOn(std::span<const GroupSweeps> groups, Crew* crew, BlockFrame* frame);
  /// The same of one group.
  void MoveGroupOn(int group, BlockFrame* frame);

 private:
  class Pass;
  /// Bodies of an island, which are summed up by themselves.
  struct Part {
    int island, first, count;  ///< in slots_
  };
  void ReadPlan(const Plan& plan);
  void Remember(const BlockData& now, Crew* crew);
  void FindEnds(const Plan& plan);
  void FindParts(const Plan& plan);
  /// Whether one thread moves a group, so that nobody waits.
  static bool MovesAlone(const Group& group);
  /// What the last sweep did along the direction of an island: of a part of its bodies.
  void FindProgress(int part, BlockFrame* frame);
  /// Islands of a group whose sweep went back have no direction; the ratio of the next sweep to
  /// this one is known all the same. @pre FindProgress() of its parts
  void ForgetWhereGoneBack(int group);
  void MoveImpulses(int first_block, int blocks, BlockFrame* frame);
  void MoveBodies(const Group& group, BlockFrame* frame);
  simd::Momentum& MomentumOf(int island) { return now_.momenta[static_cast<size_t>(island) + 1]; }
  /// One number for each part of the state.
  struct State {
    Array<simd::Line> x;
    Array<simd::BodyLane> bodies;
  };
  /// Where islands were before the last sweep, and how they go on.
  struct Course {
    /// Along their directions; the first one is of what belongs to none, and does not move.
    Array<simd::Momentum> momenta;
    Array<double> energies;  ///< by island, of the last sweep; 0 if there was none
    State last, direction;
  };
  static void Copy(const Plan& plan, const Group& group, const Course& from, Course* to);

  Array<int> island_of_slot_;
  /// Of bodies, island by island, each in the order of the problem: sums over them are the same
  /// whatever else is in the group.
  Array<int> slots_;
  Array<Part> parts_;
  Array<int> first_part_;   ///< by group; one more at the end
  Array<int> shared_;       ///< parts of groups that one thread does not move alone
  Array<double> progress_;  ///< by part
  /// Rows of an island do not take part in further sweeps than that.
  struct End {
    int group, sweeps, island;
    friend auto operator<=>(const End&, const End&) = default;
  };
  Array<End> ends_;        ///< of the plan
  Array<int> newest_end_;  ///< by island, while ends are looked for
  int plan_number_ = -1;
  bool known_ = false, kept_known_ = false;  ///< `last` of each is a state of this frame
  Course now_, kept_;
};

}  // namespace cairn
