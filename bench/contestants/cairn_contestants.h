// SPDX-License-Identifier: MIT
#pragma once

#include <cairn/bullet/constraint_solver.h>

#include <chrono>
#include <string>
#include <utility>

#include "contestants/contestant.h"

namespace cairn::cli {

/// Cairn's solver, which shows its answer after each substep.
class ObservedCairn : public bullet::ConstraintSolver {
 public:
  using bullet::ConstraintSolver::ConstraintSolver;

  void Observe(Contestant::Observer observer) { observer_ = std::move(observer); }
  std::chrono::nanoseconds TakeObservingTime() { return std::exchange(observing_, {}); }
  void allSolved(const btContactSolverInfo& info, btIDebugDraw* debug_drawer) override;

 private:
  Contestant::Observer observer_;
  std::chrono::nanoseconds observing_{0};
};

/// Cairn in its Bullet adapter. With a budget it goes by the clock, without one by iterations.
class CairnContestant : public Contestant {
 public:
  explicit CairnContestant(const Settings& settings) : solver_(settings) {}

  btConstraintSolver* solver() override { return &solver_; }
  bullet::ConstraintSolver* cairn() override { return &solver_; }
  void Observe(Observer observer) override { solver_.Observe(std::move(observer)); }
  std::chrono::nanoseconds TakeObservingTime() override { return solver_.TakeObservingTime(); }

  void Begin(const Effort& effort, btContactSolverInfo* info) override;
  Work work() const override;
  std::string refusal() const override;
  void RecordSpans(SpanRecorder* recorder) override { solver_.settings().tuning.spans = recorder; }
  int threads() override { return solver_.settings().threads; }
  void AllowThreads(int threads) override { solver_.settings().threads = threads; }

 private:
  ObservedCairn solver_;
};

}  // namespace cairn::cli
