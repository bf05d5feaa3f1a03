// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>

#include "cairn/budget.h"
#include "cairn/report.h"

namespace cairn {

/// What kind of work is charged: each has its own price in nanoseconds.
enum class WorkKind { kSweep, kStep };

/// Nanoseconds a work unit takes on this machine, learnt from timed frames; see BudgetMeter.
struct WorkPrices {
  double sweep_ns = 20;
  double step_ns = 20;
};

/// Counts work, and says when the budget is spent. Reads the clock for Budget::Time only.
class BudgetMeter {
 public:
  /// Of a time, what @p units_after of sweep work after the iteration will take is set aside.
  BudgetMeter(Budget budget, double units_after, WorkPrices* prices);

  /// Work of one kind begins: time since the last Charge() went elsewhere, and says nothing of its
  /// price.
  void Begin();
  /// Adds work that was done since Begin() or the last Charge(). @p units >= 0.
  void Charge(WorkKind kind, double units);

  /// No more work may be started.
  bool spent() const { return spent_; }
  /// Whether a step of @p step_units and sweeps of @p sweep_units after it are predicted to fit.
  bool Fits(double step_units, double sweep_units) const;

  StopReason stop_reason() const;
  std::int64_t work() const { return static_cast<std::int64_t>(work_); }
  /// 0 unless the budget is a time.
  std::chrono::nanoseconds elapsed() const;

 private:
  using Clock = std::chrono::steady_clock;

  /// Nanoseconds of the budget that are left for the iteration. @pre the budget is a time
  double TimeLeft(Clock::time_point now) const;

  Budget budget_;
  double units_after_;
  WorkPrices* prices_;
  Clock::time_point start_, last_;
  double work_ = 0;
  bool spent_ = false;
};

}  // namespace cairn
