// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "cairn/detail/memory.h"
#include "plan/colouring.h"
#include "plan/pair_order.h"
#include "plan/pairs.h"
#include "plan/row_kind.h"
#include "problem/islands.h"
#include "runtime/crew.h"
#include "simd/pairs/pair_block.h"

namespace cairn {

/// An island of the plan.
struct PlannedIsland {
  int first_body = -1;  ///< Lowest index in the problem, -1 for rows that nothing can move for.
  int bodies = 0, rows = 0;
  int group = 0;
  bool joints = false;  ///< that hold bodies together
};

/// A large island, or several small ones that fill the lanes together. Blocks, impulses and bodies
/// of a group are side by side, and shared with no other. Runs of a large one are its blocks, one
/// by one; those of small ones share blocks, whatever their colours.
struct Group {
  /// Small islands share groups of at most so many rows: blocks, impulses and bodies of a group
  /// then fit the first two levels of the cache, its lanes are full, and a budget is exceeded by no
  /// more. Larger islands are swept by colours.
  static constexpr int kSharedRows = 2048;

  int first_block = 0, blocks = 0;
  int first_run = 0, runs = 0;
  int first_x = 0, x_lines = 0;
  int first_slot = 0, slots = 0;
  int first_island = 0, islands = 0;  ///< in Plan::islands_of_groups()
  std::int64_t rows = 0;
};

/// Blocks that one thread relaxes, in their order.
struct Unit {
  int first_block = 0, blocks = 0;
  int group = 0;
  int rows = 0;
};

/// Units that share no movable body: any number of threads may work on them. A sweep is all stages
/// in their order.
struct Stage {
  int first_unit = 0, units = 0;
  int rows = 0;
};

/// Stages that follow each other, and share no movable body either.
struct Phase {
  int first_stage = 0, stages = 0;
  int first_unit = 0, units = 0;
};

/// The order of work, from the structure of the problem and what was planned before: pairs keep
/// their colours and their order, see Colouring and PairOrder, and only where pairs begin, end or
/// get other rows does it change.
class Plan {
 public:
  /// @p kinds: of all rows, each valid by ReadKind(). False if a parent is not valid, by
  /// Validate(); the plan is then of no use.
  /// @pre bodies, joints and manifolds of the problem are valid
  [[nodiscard]] bool Make(const ContactProblem& problem, std::span<const RowKind> kinds,
                          const MovableBodies& movable, Crew* crew);

  std::span<const simd::PairBlock> blocks() const { return blocks_; }
  /// In the order of a sweep: colour by colour.
  std::span<const simd::LaneRun> runs() const { return runs_; }
  int colour_of(int run) const { return colour_of_run_[run]; }
  /// Runs of a group. An island has its lanes in this order whoever shares the blocks, so that sums
  /// over them have the same bits.
  std::span<const simd::LaneRun> runs_of(const Group& group) const {
    return std::span(runs_).subspan(group.first_run, group.runs);
  }
  /// Pair of a lane. @pre lane < blocks()[block].lanes
  const Pair& pair(int block, int lane) const {
    return list_.pairs[pair_of_lane_[block * simd::kLanes + lane]];
  }
  int island_of(int block, int lane) const { return islands_of(block)[lane]; }
  /// Islands of all lanes, -1 for those that are not used.
  const int* islands_of(int block) const { return &island_of_lane_[block * simd::kLanes]; }
  /// Lanes of an island, kLanes numbers for each block, in their order.
  /// @pre the island shares its group with others
  std::span<const int> lanes_of(int island) const {
    const auto begin = static_cast<size_t>(lanes_begin_[island]);
    return std::span(lanes_of_islands_).subspan(begin, lanes_begin_[island + 1] - begin);
  }
  /// Problem rows of a pair. @pre it is made of rows
  std::span<const int> rows_of(const Pair& pair) const { return list_.rows_of(pair); }

  std::span<const Group> groups() const { return groups_; }
  std::span<const Stage> stages() const { return stages_; }
  /// All stages, in their order: what is to be done without a look at the budget in between.
  std::span<const Phase> phases() const { return phases_; }
  std::span<const Unit> units() const { return units_; }
  std::span<const PlannedIsland> islands() const { return islands_; }
  /// -1 for a body without rows.
  std::span<const int> island_of_body() const { return island_finder_.island_of_body(); }
  std::span<const int> islands_of_groups() const { return islands_of_groups_; }
  /// Those of one of groups().
  std::span<const int> islands_in(const Group& group) const {
    return islands_of_groups().subspan(group.first_island, group.islands);
  }
  /// Body of each slot, kWorld for those that belong to none: the first, and one for each pair that
  /// cannot move.
  std::span<const int> body_of_slot() const { return body_of_slot_; }
  /// Slot of each body, 0 for one without rows.
  std::span<const int> slot_of_body() const { return slot_of_body_; }
  /// Slots behind those of bodies: what the lanes of a run see of a body that they share.
  std::span<const simd::BodyCopy> copies() const { return copies_; }
  int first_copy() const { return static_cast<int>(body_of_slot_.size()); }
  /// Those of bodies and of copies.
  size_t slots() const { return body_of_slot_.size() + copies_.size(); }
  /// The copy that a slot is of, nullptr for one of a body.
  const simd::BodyCopy* copy_at(int slot) const {
    return slot < first_copy() ? nullptr : &copies_[slot - first_copy()];
  }
  /// The slot of the body itself.
  int own_slot(int slot) const {
    const simd::BodyCopy* const copy = copy_at(slot);
    return copy != nullptr ? copy->slot : slot;
  }
  int data_lines() const { return data_lines_; }
  int x_lines() const { return x_lines_; }
  /// Rows of blocks with copies.
  int d_ratio_lines() const { return d_ratio_lines_; }

 private:
  void FindIslands(int bodies);
  void FindGroups();
  void SortPairs(Crew* crew);
  int ColourOfPair(int pair) const;
  /// Pairs that are relaxed at a time: alike, and of one colour, which share no body, or of none.
  struct Draft {
    int colour = 0, lanes = 0;
    int unmoved_slot = 0;  ///< of the first, where nothing can move for them
    int first_copy = 0, copies = 0;
    int pairs[simd::kLanes];
  };
  void DraftAllRuns();
  size_t DraftRuns(int group, size_t first);
  size_t DraftOverflow(size_t first);
  Draft& AddDraft(int pair);
  Draft* FindOpenDraft(int pair, size_t first_draft);
  int SharersOf(const Draft& draft, int body) const;
  int CopiesOf(const Draft& draft) const;
  int SlotIn(const Draft& draft, int body, int* copy);
  void FillBlocks(Crew* crew);
  void PlaceRuns(const Group& group);
  int FindRoom(const Draft& draft, bool small);
  void FindAlike(const Group& group);
  void ListLanes();
  void AddBlock(int pair);
  void FillLanes(const Draft& draft, const simd::LaneRun& run);
  void GiveSlots(size_t bodies);
  int SlotOf(int body);
  void FindStages();
  void StagesOf(int group);
  int ColourOf(const Group& group, int block) const;
  void AddUnits(int first_block, int end_block, int group);
  /// Begins a stage: a phase of its own, or one more of the last.
  enum class Follows { kNothing, kLastPhase };
  void AddStage(Follows follows);
  void AddUnit(const Unit& unit);
  int RowsOf(int first_block, int end_block) const;

  ShapeTable shapes_;
  PairFinder pair_finder_;
  PairList list_;
  Colouring colouring_;
  IslandFinder island_finder_;

  Array<PlannedIsland> islands_;
  Array<int> islands_of_groups_;
  Array<int> island_of_pair_;
  Array<char> joints_of_shape_;
  Array<Group> groups_;

  PairOrder pair_order_;
  std::span<const PairKey> keys_;  ///< of pair_order_
  Array<int> order_;               ///< pairs in the order of a sweep
  Array<simd::PairBlock> blocks_;
  Array<simd::LaneRun> runs_;
  Array<int> pair_of_lane_, island_of_lane_;
  Array<int> lanes_of_islands_, lanes_begin_;  ///< of those that share a group
  Array<int> colour_of_run_;
  Array<Draft> drafts_;     ///< of all runs
  Array<int> overflow_;     ///< pairs of a group and kind that have no colour
  Array<int> open_blocks_;  ///< of small islands: the last with room for more, by KindOf(), or -1
  Array<int> slot_of_body_, body_of_slot_;
  Array<simd::BodyCopy> copies_;
  Array<Unit> units_;
  Array<Stage> stages_;
  Array<Phase> phases_;
  int data_lines_ = 0, x_lines_ = 0, d_ratio_lines_ = 0;
};

}  // namespace cairn
