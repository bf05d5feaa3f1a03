// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "cairn/solver.h"
#include "rows/row_solver.h"

namespace cairn::cli {

/// cairn::Solver on a frame as it was recorded. Prepare() makes it forget: a solver that is given
/// the same frame again compares steps with none, and every other frame would go without.
class CairnRowSolver : public RowSolver {
 public:
  CairnRowSolver(Method method, const LcpOptions& options);
  CairnRowSolver() = default;

  Settings& settings() { return solver_.settings(); }
  /// Of the last IterateUntil().
  const Report& report() const { return report_; }

  std::string Prepare(const RowProblem& problem) override;
  void IterateUntil(const RowLimit& limit) override;
  RowOutcome Result() override;

 private:
  Solver solver_;
  Impulses impulses() { return {row_impulses_, point_impulses_, twist_impulses_, joint_impulses_}; }

  const RowProblem* problem_ = nullptr;
  std::vector<double> row_impulses_;
  std::vector<ContactImpulse> point_impulses_;
  std::vector<TwistImpulse> twist_impulses_;
  std::vector<float> joint_impulses_;
  std::vector<Velocity> velocities_;
  Report report_;
};

}  // namespace cairn::cli
