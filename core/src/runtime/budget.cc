// SPDX-License-Identifier: MIT
#include "runtime/budget.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cairn {
namespace {

/// Safety on the predicted time of a step, which depends on the set that it finds.
constexpr double kStepMargin = 1.25;
/// Weight of the newest measurement in a price.
constexpr double kPriceWeight = 0.05;
/// The same for steps, of which there are few.
constexpr double kStepWeight = 0.2;
/// What a step that is tried to learn its price, and cannot be given up, may take beyond the budget
/// [ns], as far as known; and no more than the budget once again.
constexpr double kMostExploration = 1e5;
/// What comes after the iteration, and what cannot be given up, is overrun if too little is set
/// aside for it: such a price rises at once, up to so many times itself, and falls slowly. What was
/// interrupted does not say how far.
constexpr double kMostRise = 2, kInterruptedRise = 1.25, kFinishWeight = 0.02;
/// No work is cheaper than that, whatever a clock says that stands still [ns].
constexpr double kLeastPrice = 0.05;
/// Frames from one trial to the next, at first and at most.
constexpr int kFirstPatience = 8, kLongestPatience = 256;
/// Room for what the clock is asked in a frame: memory is not to be asked for each time that it is
/// asked more often than before.
constexpr int kUsualAnswers = 1024;
/// A measurement above so many times the price was interrupted by something else.
constexpr double kMostSurprise = 4;

double ToDouble(std::chrono::nanoseconds time) { return static_cast<double>(time.count()); }

void Learn(double measured, double memory, double* price) {
  *price += memory * (std::clamp(measured, kLeastPrice, kMostSurprise * *price) - *price);
}

void LearnMost(double measured, double memory, double* price) {
  if (measured > kMostSurprise * *price) {
    *price *= kInterruptedRise;
  } else if (measured > *price) {
    *price = std::min(measured, kMostRise * *price);
  } else {
    Learn(measured, memory, price);
  }
}

}  // namespace

BudgetMeter::BudgetMeter(Budget budget, double rows, WorkPrices* prices, const Clock* clock)
    : budget_(budget), rows_(rows), prices_(prices), clock_(clock) {
  if (budget_.kind() == Budget::Kind::kTime) start_ = ReadClock(clock_);
  Charge(WorkKind::kSweep, 0);
}

BudgetMeter::BudgetMeter(const Replay& replay, WorkPrices* prices)
    : budget_(Budget::Work(replay.work)), rows_(0), prices_(prices), replayed_(&replay) {
  Charge(WorkKind::kSweep, 0);
}

void BudgetMeter::Record(Replay* replay) {
  replay->fits.clear();
  replay->work = spent_ ? 0 : Replay{}.work;
  if (budget_.kind() != Budget::Kind::kTime) return;
  record_ = replay;
  replay->fits.reserve(kUsualAnswers);
}

void BudgetMeter::Begin() {
  if (budget_.kind() == Budget::Kind::kTime) last_ = Now();
}

BudgetMeter::Nanoseconds BudgetMeter::Now() const {
  latest_ = std::max(latest_, ReadClock(clock_) - start_);
  return latest_;
}

void BudgetMeter::Charge(WorkKind kind, double units) {
  // whole units: a replay ends where the time was up because work grew there
  work_ += std::ceil(units);
  switch (budget_.kind()) {
    case Budget::Kind::kUnlimited:
      return;
    case Budget::Kind::kWork:
      spent_ = work_ >= static_cast<double>(budget_.work());
      return;
    case Budget::Kind::kTime:
      break;
  }
  const Nanoseconds now = Now();
  if (units > 0) {
    const double ns = ToDouble(now - last_) / units;
    if (kind == WorkKind::kSweep) {
      Learn(ns, kPriceWeight, &prices_->sweep_ns);
    } else if (kind == WorkKind::kAnalysis) {
      LearnMost(ns, kStepWeight, &prices_->analysis_ns);
    } else if (kind == WorkKind::kStep) {
      steps_predicted_ += units * prices_->step_ns;
      steps_time_ += now - last_;
      LearnStep(ns);
    }
  }
  last_ = now;
  if (spent_ || TimeLeft(now) > 0) return;
  spent_ = true;
  if (record_ != nullptr) record_->work = work();
}

void BudgetMeter::ChargeStep(double units, bool given_up) {
  if (!given_up || budget_.kind() != Budget::Kind::kTime) {
    Charge(WorkKind::kStep, units);
    if (budget_.kind() == Budget::Kind::kTime) Answer(true);
    return;
  }
  // it takes that long at least
  const double ns = ToDouble(Now() - last_) / units;
  if (ns > prices_->step_ns) Learn(ns, 1, &prices_->step_ns);
  stepped_ = true;
  Charge(WorkKind::kPartOfStep, units);
  Answer(false);
}

void BudgetMeter::LearnStep(double ns) {
  // what was tried first was cold, what is tried for once says more than what is long known
  const bool news = explores_ || !prices_->step_known;
  Learn(ns, news ? 1 : kStepWeight, &prices_->step_ns);
  prices_->step_known = stepped_ = true;
}

void BudgetMeter::ChargeFinish() {
  if (refused_ && !stepped_) {
    ++prices_->frames_refused;
  } else if (stepped_) {
    prices_->frames_refused = 0;
    const int longer = std::clamp(2 * prices_->frames_to_refuse, kFirstPatience, kLongestPatience);
    prices_->frames_to_refuse = explores_ ? longer : kFirstPatience;
  }
  if (budget_.kind() != Budget::Kind::kTime || rows_ <= 0) return;
  const double ns = ToDouble(Now() - last_) / rows_;
  LearnMost(ns, kFinishWeight, &prices_->finish_ns);
}

double BudgetMeter::TimeLeft(Nanoseconds now) const {
  const double sweep_units = aside_units_ + std::min(rows_, prices_->unseen_rows);
  return ToDouble(budget_.time()) - ToDouble(now) - rows_ * prices_->finish_ns -
         sweep_units * prices_->sweep_ns;
}

void BudgetMeter::Answer(bool answer) {
  if (record_ != nullptr) record_->fits.push_back(answer ? 1 : 0);
}

bool BudgetMeter::Late(double sweep_units) {
  if (replayed_ != nullptr) {
    return answers_ < replayed_->fits.size() && replayed_->fits[answers_++] != 0;
  }
  if (budget_.kind() != Budget::Kind::kTime) return false;
  const bool late = TimeLeft(Now()) <= sweep_units * prices_->sweep_ns;
  Answer(late);
  return late;
}

Deadline BudgetMeter::StepDeadline() const {
  if (budget_.kind() != Budget::Kind::kTime) return {};
  const Nanoseconds passed = Now(), now = start_ + passed;
  // a budget may be as long as there are nanoseconds
  const Nanoseconds most = Nanoseconds::max() - std::max(now, Nanoseconds(0));
  const double left = std::max(0.0, TimeLeft(passed));
  return {clock_, now + (left < ToDouble(most) ? Nanoseconds(std::llround(left)) : most)};
}

bool BudgetMeter::ReplaysGivingUp() {
  if (replayed_ == nullptr) return false;
  return answers_ >= replayed_->fits.size() || replayed_->fits[answers_++] == 0;
}

double BudgetMeter::work_left() const {
  if (budget_.kind() != Budget::Kind::kWork) return std::numeric_limits<double>::infinity();
  return static_cast<double>(budget_.work()) - work_;
}

bool BudgetMeter::Predict(const Plans& plans) const {
  switch (budget_.kind()) {
    case Budget::Kind::kUnlimited:
      return true;
    case Budget::Kind::kWork:
      return work_ + (plans.step_units + plans.analysis_units) + plans.sweep_units <=
             static_cast<double>(budget_.work());
    case Budget::Kind::kTime:
      break;
  }
  // sweeps end where the budget does
  const double steps =
      plans.step_units * prices_->step_ns + plans.analysis_units * prices_->analysis_ns;
  return kStepMargin * steps + plans.sweep_units * prices_->sweep_ns <= TimeLeft(Now());
}

bool BudgetMeter::Explores(double step_units, double sweep_units) const {
  if (budget_.kind() != Budget::Kind::kTime || step_units <= 0 || stepped_) return false;
  if (prices_->frames_refused < prices_->frames_to_refuse) return false;
  const double left = TimeLeft(Now()) - sweep_units * prices_->sweep_ns;
  // the first one was slowed down by cold caches
  const double slowest = prices_->step_known ? std::min(prices_->step_ns, prices_->most_step_ns)
                                             : prices_->most_step_ns;
  const double most = std::min(kMostExploration, ToDouble(budget_.time()));
  return kStepMargin * step_units * prices_->least_step_ns <= left &&
         (prices_->can_give_up_steps || step_units * slowest - left <= most);
}

bool BudgetMeter::Fits(double step_units, double sweep_units) {
  if (replayed_ != nullptr) {
    return answers_ < replayed_->fits.size() && replayed_->fits[answers_++] != 0;
  }
  bool fits = Predict({.step_units = step_units, .sweep_units = sweep_units});
  if (!fits && step_units > 0) {
    fits = Explores(step_units, sweep_units);
    (fits ? explores_ : refused_) = true;
  }
  Answer(fits);
  return fits;
}

bool BudgetMeter::FitsAnalysis(double analysis_units, double step_units, double sweep_units) {
  if (replayed_ != nullptr) return Fits(0, 0);
  const bool fits = Predict({analysis_units, step_units, sweep_units});
  if (!fits) refused_ = true;
  Answer(fits);
  return fits;
}

StopReason BudgetMeter::stop_reason() const {
  return timed() ? StopReason::kTimeSpent : StopReason::kWorkSpent;
}

std::chrono::nanoseconds BudgetMeter::steps_predicted() const {
  return std::chrono::nanoseconds(std::llround(steps_predicted_));
}

std::chrono::nanoseconds BudgetMeter::elapsed() const {
  if (budget_.kind() != Budget::Kind::kTime) return std::chrono::nanoseconds(0);
  return Now();
}

}  // namespace cairn
