// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "cairn/detail/memory.h"
#include "cairn/report.h"
#include "plan/plan.h"
#include "sweep/block_sweep.h"

namespace cairn {

/// The sweeps since the last step, or since the frame began: where they begin, and Residual::energy
/// after so many of them, the first and two later ones, each twice as far.
struct SweepRun {
  struct Mark {
    int sweeps = 0;
    double energy = 0;
  };
  int begin = 0;
  Mark start, quarter, half;

  void Begin(int first, int sweeps_made, double energy);
  /// @p sweeps_made: of the frame, after which sweeps saw @p energy
  void See(int sweeps_made, double energy);
};

/// Rows of the groups that are active.
double RowsOf(const Plan& plan, std::span<const GroupSweeps> groups);

/// Where an island is between two decisions:
///
///   sweeping --Step()--> stepped --Judge()--> judged --MayStep()--> sweeping
///
/// A step is judged after the round of sweeps that follows it, and the round after that is one of
/// sweeps alone. Stop() ends sweeping and judged.
class IslandProgress {
 public:
  bool sweeping() const { return phase_ == Phase::kSweeping; }
  bool stepped() const { return phase_ == Phase::kStepped; }
  bool done() const { return phase_ == Phase::kDone; }
  /// Neither done, nor to be compared with itself first.
  bool open() const { return !done() && !stepped(); }

  void Step() { phase_ = Phase::kStepped; }
  void Judge() { phase_ = Phase::kJudged; }
  void Stop() { phase_ = Phase::kDone; }
  /// Whether a step may be taken before the round to come; where one was just judged, it may before
  /// the next one.
  bool MayStep();
  /// No step fits into this frame any more.
  void EndSteps() { too_late_ = true; }

  Residual seen;  ///< by the last measured sweep
  SweepRun run;

 private:
  enum class Phase { kSweeping, kStepped, kJudged, kDone };
  Phase phase_ = Phase::kSweeping;
  bool too_late_ = false;
};

/// All islands of a frame, their part of the report, and the sweeps of their groups.
class CycleIslands {
 public:
  /// @p no_step: what the report says of islands that no step was looked at for. The plan stays
  /// until the next Begin().
  void Begin(const Plan& plan, NoStep no_step);

  int count() const { return static_cast<int>(states_.size()); }
  IslandProgress& operator[](int island) { return states_[island]; }
  const IslandProgress& operator[](int island) const { return states_[island]; }
  IslandReport& report(int island) { return reports_[island]; }
  const IslandReport& report(int island) const { return reports_[island]; }
  std::span<const IslandProgress> states() const { return states_; }

  /// By group: whether it is swept on, and how often it was.
  std::span<GroupSweeps> groups() { return groups_; }
  GroupSweeps& group_of(int island) { return groups_[plan_->islands()[island].group]; }
  const GroupSweeps& group_of(int island) const { return groups_[plan_->islands()[island].group]; }
  /// Some group is swept on.
  bool active() const;
  double ActiveRows() const;
  /// Of the groups that are swept on.
  int SweepsMade() const;
  int StepsTaken(int island) const;
  /// Reads what the last sweep of these groups saw, into IslandProgress::seen where islands are not
  /// done.
  void See(std::span<const GroupSweeps> groups, BlockSweeps* sweeps);
  /// Likewise of the last one of some sweeps of a group.
  void See(int group);
  /// What sweeps of groups that go on see, by island, before it is seen.
  std::span<Residual> sights() { return last_seen_; }
  /// The same of an island of these groups, done or not.
  const Residual& last_seen(int island) const { return last_seen_[island]; }
  /// Takes down how far the sweeps of open islands have come.
  void SeeRuns();

  /// It keeps the state it has, once its group is closed.
  void Stop(int island, StopReason reason);
  /// Ends groups all of whose islands are done. function(island) for islands that have stopped
  /// since and whose lanes go on with the others of their group.
  template <class Function>
  void CloseGroups(const Function& function);

 private:
  const Plan* plan_ = nullptr;
  Array<IslandProgress> states_;
  Array<IslandReport> reports_;
  Array<GroupSweeps> groups_;
  Array<int> not_done_;  ///< islands of each group
  Array<int> stopped_;   ///< since groups were closed
  Array<Residual> last_seen_;
};

template <class Function>
void CycleIslands::CloseGroups(const Function& function) {
  for (int island : stopped_) {
    const int group = plan_->islands()[island].group;
    GroupSweeps& sweeps = groups_[group];
    sweeps.active = sweeps.active && not_done_[group] > 0;
    if (sweeps.active) function(island);
  }
  stopped_.clear();
}

/// Groups that the next measurement is for.
class GroupChoice {
 public:
  void Begin(const Plan& plan);
  void Clear();
  void AddAll();
  void Add(int island) { groups_[plan_->islands()[island].group].active = true; }
  bool Has(int island) const { return groups_[plan_->islands()[island].group].active; }
  std::span<GroupSweeps> groups() { return groups_; }
  std::span<const GroupSweeps> groups() const { return groups_; }
  double Rows() const;

 private:
  const Plan* plan_ = nullptr;
  Array<GroupSweeps> groups_;
};

}  // namespace cairn
