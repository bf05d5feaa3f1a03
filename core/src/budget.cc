// SPDX-License-Identifier: MIT
#include "budget.h"

#include <algorithm>

namespace cairn {
namespace {

/// Safety on the predicted time of a step, which depends on the set that it finds.
constexpr double kStepMargin = 1.5;
/// Weight of the newest measurement in a price.
constexpr double kPriceMemory = 0.05;
/// A measurement above so many times the price was interrupted by something else.
constexpr double kMostSurprise = 4;

}  // namespace

BudgetMeter::BudgetMeter(Budget budget, double units_after, WorkPrices* prices)
    : budget_(budget), units_after_(units_after), prices_(prices) {
  if (budget_.kind() == Budget::Kind::kTime) start_ = last_ = Clock::now();
  Charge(WorkKind::kSweep, 0);
}

void BudgetMeter::Begin() {
  if (budget_.kind() == Budget::Kind::kTime) last_ = Clock::now();
}

void BudgetMeter::Charge(WorkKind kind, double units) {
  work_ += units;
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
    const double ns = std::chrono::duration<double, std::nano>(now - last_).count() / units;
    double& price = kind == WorkKind::kSweep ? prices_->sweep_ns : prices_->step_ns;
    price += kPriceMemory * (std::min(ns, kMostSurprise * price) - price);
  }
  last_ = now;
  spent_ = TimeLeft(now) <= 0;
}

double BudgetMeter::TimeLeft(Clock::time_point now) const {
  const std::chrono::duration<double, std::nano> left = budget_.time() - (now - start_);
  return left.count() - units_after_ * prices_->sweep_ns;
}

bool BudgetMeter::Fits(double step_units, double sweep_units) const {
  switch (budget_.kind()) {
    case Budget::Kind::kUnlimited:
      return true;
    case Budget::Kind::kWork:
      return work_ + step_units + sweep_units <= static_cast<double>(budget_.work());
    case Budget::Kind::kTime:
      break;
  }
  const double needed =
      kStepMargin * (step_units * prices_->step_ns + sweep_units * prices_->sweep_ns);
  return needed <= TimeLeft(Clock::now());
}

StopReason BudgetMeter::stop_reason() const {
  return budget_.kind() == Budget::Kind::kTime ? StopReason::kTimeSpent : StopReason::kWorkSpent;
}

std::chrono::nanoseconds BudgetMeter::elapsed() const {
  if (budget_.kind() != Budget::Kind::kTime) return std::chrono::nanoseconds(0);
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start_);
}

}  // namespace cairn
