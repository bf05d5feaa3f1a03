// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "cairn/settings.h"
#include "pack/block_frame.h"
#include "runtime/budget.h"
#include "runtime/crew.h"
#include "runtime/in_parts.h"

namespace cairn {

/// What sweeps need to know of a group, and say of it.
struct GroupSweeps {
  bool active = false;
  int sweeps = 0;  ///< made so far
};

/// Sweeps over the groups that are active, by whoever of the crew is there. Between stages the
/// budget is looked at: 8192 rows, and the rest of a unit or small group.
class BlockSweeps {
 public:
  /// What a measurement costs, in sweeps.
  static constexpr double kMeasureSweeps = 0.6;

  BlockSweeps(BlockFrame* frame, const Settings& settings, BudgetMeter* meter, Crew* crew)
      : frame_(frame), settings_(settings), meter_(meter), crew_(crew) {}

  /// Whether all groups can be gone over one after the other: nobody shares the work, and nobody
  /// looks at the budget in between.
  bool InOneGo() const;

  /// Makes @p count sweeps, the last one measured (BlockFrame::errors()). False if the budget ended
  /// first: what is done stays, a valid state, and complete sweeps count.
  bool Sweep(int count, std::span<GroupSweeps> groups);
  /// One measured sweep, to its end.
  void SweepWhole(std::span<GroupSweeps> groups);
  /// The same of one group, free of charge. @pre InOneGo()
  void SweepGroup(int group, int sweeps_made);

  /// A sweep over rows of friction alone, free of charge: the end of what was swept before.
  void SweepFriction(std::span<const GroupSweeps> groups);

  /// Natural residuals of the active groups, into BlockFrame::errors().
  void Measure(std::span<const GroupSweeps> groups);
  /// Residuals likewise, free of charge: to keep and to write results, not to get to them.
  void MeasureFree(std::span<const GroupSweeps> groups);

  /// What the errors of active groups amount to, for each of their islands, into one entry for each
  /// of the plan.
  void ErrorsOfIslands(std::span<const GroupSweeps> groups, std::span<Residual> residuals) {
    ErrorsOfIslands(groups, residuals, [](int) {});
  }
  /// The same, and then(group) for each of these groups, on any thread.
  template <class Then>
  void ErrorsOfIslands(std::span<const GroupSweeps> groups, std::span<Residual> residuals,
                       const Then& then);
  /// The same for the islands of one group.
  void ErrorsOfGroup(const Group& group, std::span<Residual> residuals) const;

 private:
  static constexpr int kManyBlocks = 128;
  /// Errors of islands are added up: no pass over the plan.
  static constexpr SpanLabel kErrors{SpanKind::kMeasure, 0, -1};
  class Pass;
  /// What goes over blocks, so many times, the last time with another kernel.
  struct Kernels {
    SpanKind kind;
    int count;
    simd::PairKernels::Kernel others, last;
  };
  /// Some blocks of a group, as the next kernel is to see them.
  simd::PairWork WorkOn(const Group& group, int first_block, int blocks, int sweeps_made) const;
  /// Over each active group so often before the next one: it stays in the cache.
  void GoOver(std::span<const GroupSweeps> groups, const Kernels& kernels);
  void SweepInOneGo(int count, std::span<GroupSweeps> groups);
  /// Returns how many sweeps were made.
  int Run(Pass* pass, std::span<GroupSweeps> groups);
  void MeasureAt(double price, std::span<const GroupSweeps> groups);
  /// A look at each of its lanes takes less time than one at whole lines.
  bool HasFewLanes(const Group& group) const;
  /// A group of one island with more blocks than one thread looks at while others wait.
  bool IsForAll(const Group& group) const;
  Residual ErrorByAll(const Group& group) const;
  /// The same of a group that is one island.
  Residual ErrorOfGroup(const Group& group) const;
  Residual ErrorOfFewLanes(const Group& group) const;
  /// Likewise of some lanes, Plan::lanes_of().
  Residual ErrorOfIsland(std::span<const int> lanes) const;

  BlockFrame* frame_;
  const Settings& settings_;
  BudgetMeter* meter_;
  Crew* crew_;
};

template <class Then>
void BlockSweeps::ErrorsOfIslands(std::span<const GroupSweeps> groups,
                                  std::span<Residual> residuals, const Then& then) {
  const Plan& plan = frame_->plan();
  ForUnits(
      static_cast<int>(groups.size()), crew_,
      [&](int g) {
        const Group& group = plan.groups()[g];
        if (!groups[g].active || IsForAll(group)) return;
        ErrorsOfGroup(group, residuals);
        then(g);
      },
      kErrors);
  for (size_t g = 0; g < groups.size(); ++g) {
    const Group& group = plan.groups()[g];
    if (!groups[g].active || !IsForAll(group)) continue;
    residuals[plan.islands_of_groups()[group.first_island]] = ErrorByAll(group);
    then(static_cast<int>(g));
  }
}

}  // namespace cairn
