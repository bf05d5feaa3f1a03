// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "cairn/detail/memory.h"
#include "cholesky/front_cholesky.h"
#include "cholesky/lane_cholesky.h"
#include "pack/block_pack.h"
#include "plan/plan.h"
#include "runtime/crew.h"
#include "simd/pairs/pair_products.h"

namespace cairn {

/// What a kernel finds for whole blocks, and is added up run by run: the first run of a block calls
/// the kernel. Where runs are blocks one place serves all.
template <class Line>
class RunResults {
 public:
  RunResults(const Group& group, int lines, Array<Line>* memory)
      : group_(group), lines_(group.runs == group.blocks ? 0 : lines) {
    const auto places = static_cast<size_t>(group.runs == group.blocks ? 1 : group.blocks);
    // never shorter: what begins to be used again would be set to zero
    const size_t needed = places * static_cast<size_t>(lines);
    if (memory->size() < needed) memory->resize(needed);
    first_ = memory->data();
  }
  /// Those of the block that a run is of.
  Line* Of(const simd::LaneRun& run) const {
    return first_ + static_cast<std::ptrdiff_t>(lines_) * (run.block - group_.first_block);
  }

 private:
  const Group& group_;
  int lines_;
  Line* first_;
};

/// The reduced system of a group in body space, H = I + G_F' W G_F with a weight for each free row,
/// from rows in blocks. By the Woodbury identity it answers what the paper's (G_F G_F' + W^-1)
/// asks, but it is positive definite however redundant the rows are, and its pattern, the body
/// graph, does not change with the set.
template <class T>
class BlockSystem : public detail::Placed {
 public:
  explicit BlockSystem(simd::Target target);

  /// Finds the bodies of the group and which of them touch. False if that graph has to be analysed:
  /// if the one that was last analysed does not hold it, or much more. @p plan_number: changes with
  /// the plan.
  bool Recognise(const Plan& plan, int plan_number, int group);
  /// Recognise() was the last call for this group of this plan, and the graph is ready.
  bool IsPreparedFor(int plan_number, int group) const {
    return prepared_ && IsFor(plan_number, group);
  }
  /// Analyses the graph that was not recognised. Pairs of the one before stay in it if they are
  /// few.
  void Analyse(const Plan& plan);
  /// There is a graph that Recognise() may find again.
  bool was_analysed() const { return !bodies_.empty(); }
  /// Bodies and pairs of bodies of the group: what an analysis is to look at.
  double graph_size() const { return static_cast<double>(nodes() + joined_lanes_); }
  /// How many steps an analysis is expected to serve, >= 1: a mean that forgets.
  double steps_of_analysis() const { return std::max(expected_steps_, steps_); }
  void CountStep() { ++steps_; }

  /// Multiply-adds of a factorisation, and entries of the factor: of fronts that take as long.
  double flops() const { return lanes_.flops() + fronts_.pattern().flops(); }
  double nonzeros() const { return kLaneEntry * lanes_.nonzeros() + fronts_.pattern().nonzeros(); }

  /// Bodies of the group that can move: each is a node.
  int nodes() const { return static_cast<int>(bodies_now_.size()); }
  /// The node of a slot of a body, -1 for the world.
  int node_of_slot(int slot) const {
    return slot == 0 ? -1 : node_of_slot_[static_cast<size_t>(slot - first_slot_)];
  }
  /// What a lane sees: a node, and how much of it; see simd::BodyCopy.
  struct Seen {
    int node;
    T share;
  };
  static constexpr T kWhole = 1;
  Seen SeenAt(const Plan& plan, int slot) const {
    const simd::BodyCopy* const copy = plan.copy_at(slot);
    if (copy == nullptr) return {node_of_slot(slot), kWhole};
    return {node_of_slot(copy->slot), static_cast<T>(copy->share)};
  }

  /// Assembles and factorises. @p weights: one line for each x line of the group; rows of weight 0
  /// are left out. @p scratch: one for all systems, see RunResults. False if rounding made H
  /// indefinite. @p deadline: where it passes, nothing comes of it, nor of Solve().
  /// @pre IsPreparedFor() this group of this plan
  [[nodiscard]] bool Factorise(const Plan& plan, const Group& group, const BlockData& blocks,
                               std::span<const simd::LineOf<T>> weights,
                               Array<simd::LineOf<T>>* scratch, Crew* crew,
                               Deadline* deadline = nullptr);
  /// Solves H v = rhs in place, six numbers a node.
  void Solve(std::span<T> rhs, Deadline* deadline = nullptr);

 private:
  bool IsFor(int plan_number, int group) const {
    return plan_number == plan_number_ && group == group_;
  }
  void FindBodies(const Plan& plan, const Group& group);
  void CountLanes(const Plan& plan, const Group& group);
  bool FindLanes(const Plan& plan, const Group& group);
  void FindPairs(const Plan& plan, const Group& group);
  NodePair PairOf(const Plan& plan, const simd::PairBlock& block, int lane) const;
  void ShareOut();
  T* diagonal(int node) {
    const Place& place = places_[node];
    return place.in_lanes ? lanes_.diagonal(place.index) : fronts_.diagonal(place.index);
  }
  T* upper(int pair) {
    const Place& place = places_of_pairs_[pair];
    return place.in_lanes ? lanes_.upper(place.index) : fronts_.upper(place.index);
  }
  void AddLane(const Plan& plan, const simd::PairBlock& block, int lane, int pair,
               const simd::LineOf<T>* gram);

  const simd::PairProducts<T>& products_;
  /// Trees and chains of bodies are in lanes, other components in fronts.
  LaneCholesky<T> lanes_;
  FrontCholesky<T> fronts_;
  struct Place {
    bool in_lanes;
    int index;  ///< there
  };
  Array<Place> places_, places_of_pairs_;  ///< by node, by pair
  int in_lanes_ = 0;                       ///< nodes
  Array<T> of_lanes_, of_fronts_;          ///< right-hand sides, where there are both
  bool prepared_ = false;
  int plan_number_ = -1, group_ = -1;
  int first_slot_ = 0;
  Array<int> bodies_, bodies_now_;  ///< ascending problem indices
  Array<int> node_of_slot_;
  Array<NodePair> pairs_;  ///< of the analysed graph, ascending
  Array<int> first_pair_;  ///< by node: its first pair, where it is the first of them; and the end
  Array<NodePair> known_pairs_, all_pairs_;
  Array<int> pair_of_lane_;  ///< of the group's blocks; -1 where only one body moves
  int joined_lanes_ = 0;     ///< where two do
  double steps_ = 0, expected_steps_ = kExpectedSteps;  ///< of this analysis, and of others

  /// What an entry of a factor in lanes takes, in those of fronts.
  static constexpr double kLaneEntry = 0.5;
  /// Before anything is known: what begins to be piled up goes on so for some frames.
  static constexpr double kExpectedSteps = 4;
};

extern template class BlockSystem<float>;
extern template class BlockSystem<double>;

}  // namespace cairn
