// SPDX-License-Identifier: MIT
#include "lcp_state.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cairn::lcp {
namespace {

/// Multiply-adds of a factorisation that cost as much as one entry of M in a sweep: both are a few
/// cycles of memory and arithmetic, and the measured prices of BudgetMeter correct the rest.
constexpr double kFlopsPerEntry = 2;
/// Measuring an iterate costs about so many sweeps.
constexpr double kJudgeSweeps = 2;

/// SweepOrder::kAutomatic takes colours for so many rows and more, if there are so few colours.
constexpr int kManyRows = 20000, kFewColours = 8;

std::vector<int> ColoursFor(const Eigen::SparseMatrix<double>& m, SweepOrder order) {
  if (order == SweepOrder::kColoured) return ColourRows(m, static_cast<int>(m.cols()));
  if (order == SweepOrder::kAutomatic && m.cols() >= kManyRows) return ColourRows(m, kFewColours);
  return {};
}

}  // namespace

LcpState::LcpState(const BoxedLcp& problem, const Settings& settings, BudgetMeter* meter,
                   Crew* crew, const Observer& observer)
    : problem_(problem),
      settings_(settings),
      meter_(meter),
      crew_(crew),
      observer_(observer),
      timed_(settings.budget.kind() == Budget::Kind::kTime),
      rows_(LayOut(problem, ColoursFor(problem.M, settings.order))),
      diagonal_(problem.M.diagonal()),
      best_residual_(std::numeric_limits<double>::infinity()) {
  const double norm = std::sqrt((problem.q.array().square() / diagonal_.array()).sum());
  if (norm > 0) scale_ = norm;
  report_.phases.layout = meter->elapsed();
}

double LcpState::FlopUnits(double flops) const {
  const double rows = std::max<double>(1, rows_.size());
  return flops * rows / (kFlopsPerEntry * static_cast<double>(problem_.M.nonZeros()) + rows);
}

double LcpState::Sweep() {
  const PhaseClock clock = Time(&Phases::sweeps);
  meter_->Begin();
  const bool reverse = settings_.order == SweepOrder::kReverse ||
                       (settings_.order == SweepOrder::kSymmetric && report_.sweeps % 2 == 1);
  const double omega = settings_.method == Method::kPsor ? settings_.omega : 1;
  const Direction direction = reverse ? Direction::kReverse : Direction::kForward;
  const double moved = rows_.colours.empty() ? lcp::Sweep(rows_, omega, direction, x.data())
                                             : SweepColours(rows_, omega, crew_, x.data());
  ++report_.sweeps;
  meter_->Charge(WorkKind::kSweep, rows_.size());
  EndIfSpent();
  return std::sqrt(moved) / scale_;
}

double LcpState::SweepTimes(int count) {
  double moved = 0;
  for (int k = 0; k < count && !done(); ++k) {
    if (report_.sweeps >= settings_.max_sweeps) {
      End(StopReason::kSweepLimit);
      break;
    }
    moved = Sweep();
    Show();
  }
  return moved;
}

Eigen::VectorXd LcpState::Slack(const Eigen::VectorXd& any_x) const {
  return problem_.M * any_x + problem_.q;
}

Eigen::VectorXd LcpState::Multiply(const Eigen::VectorXd& y) const { return problem_.M * y; }

double LcpState::Judge() {
  meter_->Begin();
  const double residual = KeepIfBest();
  meter_->Charge(WorkKind::kSweep, kJudgeSweeps * rows_.size());
  EndIfSpent();
  return residual;
}

double LcpState::KeepIfBest() {
  const double residual = Measure(problem_, x).relative;
  if (residual < best_residual_) {
    best_residual_ = residual;
    best_x_ = x;
  }
  if (settings_.tolerance > 0 && residual <= settings_.tolerance) End(StopReason::kConverged);
  return residual;
}

double LcpState::SweepsFor(double flops) const {
  return FlopUnits(flops) / std::max(1, rows_.size());
}

bool LcpState::Fits(double flops) const { return meter_->Fits(FlopUnits(flops), rows_.size()); }

bool LcpState::Factorise(SparseCholesky* factor, const Eigen::VectorXd& shift) {
  meter_->Begin();
  bool ok;
  {
    const PhaseClock clock = Time(&Phases::factorisation);
    ok = factor->Factorise(shift);
  }
  ++report_.factorisations;
  report_.factor_nonzeros =
      std::max(report_.factor_nonzeros, static_cast<std::int64_t>(factor->factor_nonzeros()));
  meter_->Charge(WorkKind::kStep, FlopUnits(factor->factor_flops()));
  EndIfSpent();
  return ok;
}

void LcpState::Solve(const SparseCholesky& factor, Eigen::VectorXd* rhs) {
  const PhaseClock clock = Time(&Phases::solves);
  factor.Solve(rhs);
}

void LcpState::Show(const Eigen::VectorXd& shown) {
  if (!observer_) return;
  const Iterate iterate{
      .x = shown, .sweeps = report_.sweeps, .factorisations = report_.factorisations};
  if (!observer_(iterate)) End(StopReason::kCancelled);
}

void LcpState::Begin(const Eigen::VectorXd& start) {
  x = best_x_ = start.cwiseMax(problem_.lo).cwiseMin(problem_.hi);
  KeepIfBest();
  EndIfSpent();
  Show();
}

void LcpState::EndForBudget() {
  const bool time = meter_->stop_reason() == cairn::StopReason::kTimeSpent;
  End(time ? StopReason::kTimeSpent : StopReason::kWorkSpent);
}

void LcpState::EndIfSpent() {
  if (meter_->spent() && report_.sweeps >= settings_.min_sweeps) EndForBudget();
}

void LcpState::Fail() {
  report_.status = Status::kNotPositiveDefinite;
  End(StopReason::kBrokeDown);
}

void LcpState::End(StopReason reason) {
  if (!done()) report_.stop = reason;
}

Report LcpState::Finish(Eigen::VectorXd* result) {
  const LcpResidual residual = Measure(problem_, best_x_);
  if (!std::isfinite(residual.relative) || !best_x_.allFinite()) {
    Report overflow;
    overflow.status = Status::kOverflow;
    overflow.stop = StopReason::kBrokeDown;
    return overflow;
  }
  *result = best_x_;
  report_.residual_max = residual.max;
  report_.residual_energy = residual.energy;
  report_.residual_relative = residual.relative;
  report_.work = meter_->work();
  Phases& phases = report_.phases;
  phases.other = meter_->elapsed() - phases.layout - phases.sweeps - phases.ordering -
                 phases.analysis - phases.factorisation - phases.solves;
  if (!timed_) phases.other = {};
  return report_;
}

}  // namespace cairn::lcp
