// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "cairn/report.h"
#include "cairn/settings.h"
#include "cycle/block_steps.h"
#include "pack/block_frame.h"
#include "pack/block_snapshot.h"
#include "runtime/budget.h"
#include "runtime/crew.h"
#include "step/merit.h"
#include "sweep/block_sweep.h"
#include "sweep/nncg.h"

namespace cairn {

/// The algorithm on blocks, in legs of k_gs sweeps that all islands make together:
///
///   repeat   k_gs sweeps
///            subspace steps where they pay, and k_gs sweeps, or k_gs sweeps alone on the islands
///            that end better so
///   until the residual, the sweep limit or the budget says so
///
/// An island that is done keeps the state it had then, even where the lanes that it shares go on:
/// without a budget, no island sees the others. Nothing is allocated in a frame that is no larger
/// than those before it, steps apart.
class BlockCycle {
 public:
  /// Runs to the end on a frame that has begun. @p report: gets the islands.
  void Run(const ContactProblem& problem, const Settings& settings, BlockFrame* frame,
           IslandMemories* memories, BudgetMeter* meter, Crew* crew, Report* report);

 private:
  struct SweepMark {
    int sweeps = 0;
    double energy = 0;
  };
  /// What is known of an island on the way; its counts and its end are in islands_.
  struct IslandState {
    Residual seen;            ///< by the last measured sweep
    Residual seen_with_step;  ///< the same, while sweeps alone are tried
    Residual best;            ///< of the snapshot; its energy is infinite if there is none
    /// Sweeps since the last step, or since the frame began: where they begin, and
    /// Residual::energy after so many of them, the first and two later ones, each twice as far.
    int run_begin = 0;
    SweepMark start, quarter, half;
    bool too_late = false;  ///< a step does not fit any more
    bool stepped = false;   ///< a step was taken before this leg, and is not judged yet
    bool better_alone = false;
    bool harmful = false;  ///< the step is undone, whatever sweeps alone do
    bool rests = false;    ///< one was judged after this leg: the next leg is one of sweeps
  };

  void Begin();
  /// Scales start impulses that are worse than none.
  void GuardStart();
  /// Likewise impulses in the end.
  void GuardResult();
  void Leg();
  /// Makes so many sweeps, unless the budget ends before. The last one is seen.
  bool Sweep(int count);
  /// Moves the state on for one sweep, where that still fits.
  bool MoveOn();
  /// From what the last sweep saw.
  void LearnWays();
  /// Takes down what the first sweep saw.
  void MarkStart();
  /// Takes down how far sweeps alone have come.
  void MarkRuns();
  /// Reads what the last sweep of the groups saw.
  void See(std::span<const GroupSweeps> groups);
  void Judge(bool seen);
  /// Stops islands whose sweeps that are made in any case are done.
  void StopLate();
  void JudgeNear();
  void Stop(int island, StopReason reason);
  /// Keeps the state of islands that have stopped, where their lanes go on.
  void CloseGroups();
  bool Done(int island) const { return islands_[island].stop != StopReason::kNotStarted; }
  /// Neither done, nor to be compared with itself first.
  bool Open(int island) const { return !Done(island) && !states_[island].stepped; }
  bool Active() const;
  double ActiveRows() const { return RowsOf(made_); }        ///< of the groups that are swept
  double RowsOf(std::span<const GroupSweeps> groups) const;  ///< of the active ones
  int SweepsMade() const;
  /// Of an island, as far as steps were taken there.
  int MostSweeps(int island) const;
  /// Without a step.
  int SweepsInPlace(int island) const;
  void KeepBest();
  /// The best states, and their residuals.
  void Finish();
  /// Whether each island belongs to a group that the next measurement is for.
  bool Chosen(int island) const { return chosen_[frame_->plan().islands()[island].group].active; }
  void Choose(int island) { chosen_[frame_->plan().islands()[island].group].active = true; }
  void ChooseNone();
  /// Residuals of the islands of the groups that are chosen.
  void MeasureChosen(std::vector<Residual>* residuals);
  void ReadErrors(std::vector<Residual>* residuals) const;
  void FillReport(Report* report) const;

  // block_cycle_steps.cc
  void TakeSteps();
  void FindCandidates();
  /// A step did so much that sweeps alone need not be tried.
  bool IsSure(int island);
  void KeepBetterSteps(int sweeps);
  /// Which steps put in energy, threw or flung bodies, or left impulses that floats cannot hold.
  void FindHarm();
  /// The sweeps without its step brought an island closer to its solution than those with it.
  bool IsBetterAlone(int island);
  /// By how much a step and its sweeps brought phi down, see Merit, and so many sweeps alone [J].
  double GainOfStep(int island) const;
  double GainAlone(int island) const;
  void TryWithoutSteps(int sweeps);
  /// There is no time for that: what is no better than before the step is undone.
  void CompareWithBefore();
  /// Sets time aside to judge the steps on the islands that are chosen.
  void SetJudgingAside();
  /// Work of the steps that are to be taken after a leg, and of the sweeps that they need.
  struct PlannedSteps {
    double steps = 0, sweeps = 0;
  };
  /// Adds a step on islands of group @p g; NoStep::kEnded if it may be taken, else why not.
  NoStep PlanStep(int g, std::span<const int> islands, PlannedSteps* planned);
  /// Likewise, whether their graph is known or was analysed for it. @p planned: with the sweeps
  /// after this one
  NoStep PlanGraph(int g, std::span<const int> islands, const PlannedSteps& planned);
  /// Whether it does more than the sweeps in its place; see StepOdds. @p planned: work of steps
  /// before it
  bool StepPays(int g, std::span<const int> islands, double planned, double price);
  int StepsTaken(int island) const;
  /// Without a budget: a step may be taken, and with how many factorisations.
  NoStep Weigh(int g, int island);
  /// Of the candidates from @p first on, in group @p g.
  void KeepWorthwhile(int g, size_t first);
  /// What steps and sweeps gain is learnt.
  bool Learns() const { return watches_ || weighs_; }
  /// From here on what sweeps gain is looked at: those since the sweep @p begin.
  void BeginRun(int island, int begin);
  /// Tells the odds what sweeps gained, after the last one.
  void Learn();

  const Settings* settings_ = nullptr;
  BlockFrame* frame_ = nullptr;
  BudgetMeter* meter_ = nullptr;
  BlockSweeps* sweeps_ = nullptr;
  Crew* crew_ = nullptr;
  BlockSteps steps_;
  bool watches_ = false;  ///< what steps and sweeps make of the budget
  bool weighs_ = false;   ///< steps against the sweeps in their place, see StepPolicy::kWeighed
  bool accelerates_ = false;
  bool guards_ = false;
  Nncg nncg_;

  std::vector<GroupSweeps> made_, chosen_;
  std::vector<IslandState> states_;
  std::vector<IslandReport> islands_;
  std::vector<int> stepped_islands_, stopped_;
  std::vector<Residual> before_, after_, with_step_, alone_;  ///< by island: to compare
  IslandMerits merits_, merits_before_, alone_merits_;
  std::vector<float> scales_;  ///< by island: what a guard multiplies impulses by
  BlockSnapshot done_, best_, before_steps_, after_steps_;
  int legs_ = 0;
  bool started_ = false;  ///< a whole sweep was made
};

}  // namespace cairn
