// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>

#include "cairn/budget.h"
#include "cairn/report.h"
#include "cairn/settings.h"
#include "runtime/deadline.h"

namespace cairn {

/// Tuning::min_sweeps, with what the budget makes of it
inline int LeastSweeps(const Settings& settings) {
  if (settings.tuning.min_sweeps != Tuning::kByBudget) return settings.tuning.min_sweeps;
  const bool timed =
      settings.tuning.replay != nullptr || settings.budget.kind() == Budget::Kind::kTime;
  return timed ? Tuning::kLateSweeps : 1;
}

/// What kind of work is charged, each at its price in nanoseconds.
enum class WorkKind {
  kSweep,
  kStep,
  kPartOfStep,  ///< Of one that was given up: says little of a price.
  kAnalysis,
};

/// Nanoseconds that work takes on this machine, learnt from timed frames; see BudgetMeter.
struct WorkPrices {
  double sweep_ns = 2;     ///< a work unit of sweeps
  double step_ns = 1.3;    ///< a work unit of steps
  double analysis_ns = 2;  ///< a work unit of analyses, as of late at most
  double finish_ns = 10;   ///< a row, from the last sweep to the end of the Solve()
  /// What a work unit of steps takes on fast machines and on slow ones.
  double least_step_ns = 0.5, most_step_ns = 2.6;
  double unseen_rows = 0;          ///< relaxed between two looks at the clock, at most
  bool can_give_up_steps = false;  ///< when the time is up; see BudgetMeter::StepDeadline()

  bool step_known = false;   ///< one was timed
  int frames_refused = 0;    ///< in a row, steps did not fit
  int frames_to_refuse = 0;  ///< before the next one is tried all the same
};

/// Counts work, and says when the budget is spent. Reads the clock for Budget::Time only.
class BudgetMeter {
 public:
  /// Of a time, what the results of @p rows rows will take is set aside.
  /// @p clock: Tuning::clock
  BudgetMeter(Budget budget, double rows, WorkPrices* prices, const Clock* clock = nullptr);
  /// Makes a frame again. @p replay must outlive the meter.
  BudgetMeter(const Replay& replay, WorkPrices* prices);
  /// Keeps what the clock decides in @p replay, if the budget is a time.
  void Record(Replay* replay);

  /// Work of one kind begins: time since the last Charge() went elsewhere, and says nothing of its
  /// price.
  void Begin();
  /// Adds work that was done since Begin() or the last Charge(). @p units >= 0.
  void Charge(WorkKind kind, double units);
  /// The same of a step. Of one that was given up only a part was done; see StepDeadline().
  void ChargeStep(double units, bool given_up);
  /// The results are written: learns what that took since the last Charge() or Begin().
  void ChargeFinish();
  /// Of a time, keeps what so much work of sweeps takes for what is to come, until the next call.
  void SetAside(double sweep_units) { aside_units_ = sweep_units; }

  /// No more work may be started.
  bool spent() const { return spent_; }
  /// Likewise, as the time is up: what may be left undone is left.
  bool out_of_time() const { return spent_ && timed(); }
  /// Whether the time is too short for so much more work of sweeps. Never for another budget. The
  /// answer goes where those of Fits() go.
  bool Late(double sweep_units);
  /// When a step is to be given up.
  Deadline StepDeadline() const;
  /// Whether the step to come was given up in the frame that is made again.
  bool ReplaysGivingUp();
  /// There is a budget.
  bool limited() const { return budget_.kind() != Budget::Kind::kUnlimited; }
  /// Work units left, infinite unless the budget is of work.
  double work_left() const;
  /// Whether a step of @p step_units and sweeps of @p sweep_units after it are predicted to fit, or
  /// whether one is to be tried all the same until the time is up; see Explores().
  /// The answer goes to Replay::fits, or comes from there.
  bool Fits(double step_units, double sweep_units);

  /// The same before an analysis, which cannot be given up and is not tried.
  bool FitsAnalysis(double analysis_units, double step_units, double sweep_units);

  StopReason stop_reason() const;
  std::int64_t work() const { return static_cast<std::int64_t>(work_); }
  /// 0 unless the budget is a time.
  std::chrono::nanoseconds elapsed() const;
  /// What the steps charged so far were predicted to take, and took; likewise.
  std::chrono::nanoseconds steps_predicted() const;
  std::chrono::nanoseconds steps_time() const { return steps_time_; }

 private:
  using Nanoseconds = std::chrono::nanoseconds;

  bool timed() const { return budget_.kind() == Budget::Kind::kTime || replayed_ != nullptr; }
  /// Time since the meter began, which never runs back. @pre the budget is a time
  Nanoseconds Now() const;
  /// Nanoseconds of the budget that are left for the iteration. @pre the budget is a time
  double TimeLeft(Nanoseconds now) const;
  void Answer(bool answer);
  /// Work that may come next.
  struct Plans {
    double analysis_units = 0, step_units = 0, sweep_units = 0;
  };
  bool Predict(const Plans& plans) const;
  /// Whether a step that does not fit is tried, to learn what it takes: it would fit on a fast
  /// machine, will not exceed the budget by much if it cannot be given up, and none was tried for
  /// long.
  bool Explores(double step_units, double sweep_units) const;
  void LearnStep(double ns);

  Budget budget_;
  double rows_;
  WorkPrices* prices_;
  const Replay* replayed_ = nullptr;
  size_t answers_ = 0;  ///< of replayed_ given so far
  Replay* record_ = nullptr;
  const Clock* clock_ = nullptr;
  Nanoseconds start_{0};           ///< of the clock
  mutable Nanoseconds latest_{0};  ///< that was seen, since then
  Nanoseconds last_{0};            ///< likewise, when work began
  double aside_units_ = 0;
  double work_ = 0;
  double steps_predicted_ = 0;  ///< [ns]
  std::chrono::nanoseconds steps_time_{0};
  bool spent_ = false;
  bool refused_ = false, stepped_ = false, explores_ = false;  ///< steps, in this frame
};

}  // namespace cairn
