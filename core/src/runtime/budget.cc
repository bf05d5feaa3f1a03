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
constexpr double kPriceMemory = 0.05;
/// The same for steps, of which there are few.
constexpr double kStepMemory = 0.2;
/// The same for what comes after the iteration where it took longer than thought: what is not set
/// aside for it is overrun.
constexpr double kFinishMemory = 0.5;
/// What a step that is tried to learn its price may take beyond the budget [ns], as far as known;
/// and no more than the budget once again.
constexpr double kMostExploration = 1e5;
/// Frames from one trial to the next, at first and at most.
constexpr int kFirstPatience = 8, kLongestPatience = 256;
/// A measurement above so many times the price was interrupted by something else.
constexpr double kMostSurprise = 4;

double Nanoseconds(std::chrono::steady_clock::duration time) {
  return std::chrono::duration<double, std::nano>(time).count();
}

void Learn(double measured, double memory, double* price) {
  *price += memory * (std::min(measured, kMostSurprise * *price) - *price);
}

}  // namespace

BudgetMeter::BudgetMeter(Budget budget, double rows, WorkPrices* prices)
    : budget_(budget), rows_(rows), prices_(prices) {
  if (budget_.kind() == Budget::Kind::kTime) start_ = last_ = Clock::now();
  Charge(WorkKind::kSweep, 0);
}

BudgetMeter::BudgetMeter(const Replay& replay, WorkPrices* prices)
    : budget_(Budget::Work(replay.work)), rows_(0), prices_(prices), replayed_(&replay) {
  Charge(WorkKind::kSweep, 0);
}

void BudgetMeter::Record(Replay* replay) {
  replay->fits.clear();
  replay->work = spent_ ? 0 : Replay{}.work;
  if (budget_.kind() == Budget::Kind::kTime) record_ = replay;
}

void BudgetMeter::Begin() {
  if (budget_.kind() == Budget::Kind::kTime) last_ = Clock::now();
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
  const Clock::time_point now = Clock::now();
  if (units > 0) {
    const double ns = Nanoseconds(now - last_) / units;
    if (kind == WorkKind::kSweep) {
      Learn(ns, kPriceMemory, &prices_->sweep_ns);
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

void BudgetMeter::LearnStep(double ns) {
  // what was tried first was cold, what is tried for once says more than what is long known
  const bool news = explores_ || !prices_->step_known;
  Learn(ns, news ? 1 : kStepMemory, &prices_->step_ns);
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
  const double ns = Nanoseconds(Clock::now() - last_) / rows_;
  Learn(ns, ns > prices_->finish_ns ? kFinishMemory : kPriceMemory, &prices_->finish_ns);
}

double BudgetMeter::TimeLeft(Clock::time_point now) const {
  return Nanoseconds(budget_.time() - (now - start_)) - rows_ * prices_->finish_ns;
}

double BudgetMeter::work_left() const {
  if (budget_.kind() != Budget::Kind::kWork) return std::numeric_limits<double>::infinity();
  return static_cast<double>(budget_.work()) - work_;
}

bool BudgetMeter::Predict(double step_units, double sweep_units) const {
  switch (budget_.kind()) {
    case Budget::Kind::kUnlimited:
      return true;
    case Budget::Kind::kWork:
      return work_ + step_units + sweep_units <= static_cast<double>(budget_.work());
    case Budget::Kind::kTime:
      break;
  }
  // sweeps end where the budget does
  const double needed =
      kStepMargin * step_units * prices_->step_ns + sweep_units * prices_->sweep_ns;
  return needed <= TimeLeft(Clock::now());
}

bool BudgetMeter::Explores(double step_units, double sweep_units) const {
  if (budget_.kind() != Budget::Kind::kTime || step_units <= 0 || stepped_) return false;
  if (prices_->frames_refused < prices_->frames_to_refuse) return false;
  const double left = TimeLeft(Clock::now()) - sweep_units * prices_->sweep_ns;
  // the first one was slowed down by cold caches
  const double slowest = prices_->step_known ? std::min(prices_->step_ns, prices_->most_step_ns)
                                             : prices_->most_step_ns;
  const double most = std::min(kMostExploration, Nanoseconds(budget_.time()));
  return kStepMargin * step_units * prices_->least_step_ns <= left &&
         step_units * slowest - left <= most;
}

bool BudgetMeter::Fits(double step_units, double sweep_units) {
  if (replayed_ != nullptr) {
    return answers_ < replayed_->fits.size() && replayed_->fits[answers_++] != 0;
  }
  bool fits = Predict(step_units, sweep_units);
  if (!fits && step_units > 0) {
    fits = Explores(step_units, sweep_units);
    (fits ? explores_ : refused_) = true;
  }
  if (record_ != nullptr) record_->fits.push_back(fits ? 1 : 0);
  return fits;
}

StopReason BudgetMeter::stop_reason() const {
  const bool timed = budget_.kind() == Budget::Kind::kTime || replayed_ != nullptr;
  return timed ? StopReason::kTimeSpent : StopReason::kWorkSpent;
}

std::chrono::nanoseconds BudgetMeter::steps_predicted() const {
  return std::chrono::nanoseconds(std::llround(steps_predicted_));
}

std::chrono::nanoseconds BudgetMeter::elapsed() const {
  if (budget_.kind() != Budget::Kind::kTime) return std::chrono::nanoseconds(0);
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start_);
}

}  // namespace cairn
