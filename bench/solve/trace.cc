// SPDX-License-Identifier: MIT
#include "solve/trace.h"

#include <algorithm>
#include <utility>

namespace cairn::cli {
namespace {

/// Iterates of the history, from the hundredth on, are this share of their number apart.
constexpr long long kThinning = 100;

}  // namespace

Trace::Trace(Setup setup, std::span<const double> levels) : setup_(std::move(setup)) {
  for (const double level : levels) levels_.push_back({level, {}});
}

void Trace::Begin(const Eigen::VectorXd& start, double time) {
  const Eigen::VectorXd inside = start.cwiseMax(setup_.lcp.lo).cwiseMin(setup_.lcp.hi);
  Record({.x = inside}, time, Keep::kAlways);
  begin_ = Now(setup_.clock) - time;
}

bool Trace::Look(const lcp::Iterate& iterate) {
  const double entry = Now(setup_.clock);
  const double time = entry - begin_ - spent_;
  // Some solvers show the start too, which Begin() has recorded.
  if (iterate.sweeps > 0 || iterate.factorisations > 0) Record(iterate, time, Keep::kIfDue);
  if (setup_.show) setup_.show(iterate);
  spent_ += Now(setup_.clock) - entry;
  return !setup_.budget || time < *setup_.budget;
}

void Trace::End(const LcpOutcome& outcome) {
  const double time = Now(setup_.clock) - begin_ - spent_;
  Record({outcome.x, outcome.sweeps, outcome.factorisations}, time, Keep::kAlways);
}

bool Trace::IsLast(const HistoryPoint& point) const {
  return !history_.empty() && history_.back().sweeps == point.sweeps &&
         history_.back().factorisations == point.factorisations &&
         history_.back().error == point.error;
}

void Trace::Record(const lcp::Iterate& iterate, double time, Keep keep) {
  HistoryPoint point{.time = time,
                     .sweeps = iterate.sweeps,
                     .factorisations = iterate.factorisations,
                     .error = setup_.meter.Error(setup_.lcp, iterate.x)};
  const bool is_due = keep == Keep::kAlways || count_ >= next_;
  std::vector<LevelReached*> reached;
  for (LevelReached& level : levels_) {
    if (!level.first && point.error <= level.level) reached.push_back(&level);
  }
  if ((is_due || !reached.empty()) && !IsLast(point)) {
    point.energy_error = setup_.meter.EnergyError(setup_.lcp, iterate.x);
    point.residual = Measure(setup_.lcp, iterate.x).relative;
    history_.push_back(point);
    next_ = count_ + std::max(1LL, count_ / kThinning);
  }
  for (LevelReached* level : reached) level->first = point;
  ++count_;
}

}  // namespace cairn::cli
