// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "cairn/lcp/problem.h"
#include "cairn/lcp/settings.h"
#include "cairn/lcp/solver.h"
#include "methods/matrix_sweep.h"
#include "methods/sparse_cholesky.h"
#include "phase_clock.h"
#include "runtime/budget.h"
#include "runtime/crew.h"

namespace cairn::lcp {

/// A problem in matrix form being solved: the iterate, the best one so far, and what was spent.
/// Every method works on one of these, and ends when done() says so.
class LcpState {
 public:
  /// @pre the problem is valid. What is passed in must outlive the state.
  LcpState(const BoxedLcp& problem, const Settings& settings, BudgetMeter* meter, Crew* crew,
           const Observer& observer);

  const BoxedLcp& problem() const { return problem_; }
  const Settings& settings() const { return settings_; }
  const Eigen::VectorXd& diagonal() const { return diagonal_; }
  /// sqrt(sum q_i^2 / d_i), or 1 if q = 0: what relative residuals are relative to.
  double scale() const { return scale_; }

  /// Takes a finite start, brought inside the box. What follows it is charged to the budget.
  void Begin(const Eigen::VectorXd& start);

  /// The iterate, inside the box.
  Eigen::VectorXd x;

  /// Sweeps once, in the order of the settings. Returns how far the rows moved: sqrt(sum d_i
  /// (change of x_i)^2) / scale(), about the relative residual.
  double Sweep();
  /// Sweeps so often, or until done() or the sweep limit, and shows each iterate. Returns how far
  /// the rows moved in the last of them.
  double SweepTimes(int count);

  /// w = M x + q of any x.
  Eigen::VectorXd Slack(const Eigen::VectorXd& any_x) const;
  /// M y.
  Eigen::VectorXd Multiply(const Eigen::VectorXd& y) const;

  /// Measures x, keeps it if it is the best so far, and ends the iteration if it is good enough.
  /// Returns its relative residual.
  double Judge();
  /// x becomes the best iterate.
  void Restore() { x = best_x_; }

  /// Sweeps that cost as much as a factorisation of so many multiply-adds.
  double SweepsFor(double flops) const;
  /// Whether a factorisation of so many multiply-adds, and a sweep after it, fit the budget.
  bool Fits(double flops) const;
  /// Factorises, and books it. False if a pivot is not positive.
  [[nodiscard]] bool Factorise(SparseCholesky* factor, const Eigen::VectorXd& shift);
  void Solve(const SparseCholesky& factor, Eigen::VectorXd* rhs);

  /// The time until what is returned ends belongs to this phase.
  [[nodiscard]] PhaseClock Time(std::chrono::nanoseconds Phases::*phase) {
    return PhaseClock(timed_ ? &(report_.phases.*phase) : nullptr);
  }

  /// Shows x, or another vector inside the box, to the observer.
  void Show() { Show(x); }
  void Show(const Eigen::VectorXd& shown);

  void End(StopReason reason);
  /// The matrix is not positive definite.
  void Fail();
  /// What has to be done next does not fit the budget.
  void EndForBudget();
  bool done() const { return report_.stop != StopReason::kNotStarted; }

  int sweeps() const { return report_.sweeps; }
  int factorisations() const { return report_.factorisations; }
  /// Writes the best iterate and measures it. Status::kOverflow, and nothing is written, if it
  /// cannot be measured.
  Report Finish(Eigen::VectorXd* result);

 private:
  double KeepIfBest();
  double FlopUnits(double flops) const;
  /// The budget is spent, and the sweeps that are made in any case are done.
  void EndIfSpent();

  const BoxedLcp& problem_;
  const Settings& settings_;
  BudgetMeter* meter_;
  Crew* crew_;
  const Observer& observer_;
  bool timed_;
  SweepRows rows_;
  Eigen::VectorXd diagonal_, best_x_;
  double scale_ = 1, best_residual_ = 0;
  Report report_;
};

}  // namespace cairn::lcp
