// SPDX-License-Identifier: MIT
#pragma once

#include <cairn/bullet/constraint_solver.h>

#include "cli/contestant.h"

namespace cairn::cli {

/// Cairn in its Bullet adapter. With a budget it goes by the clock, without one by iterations.
class CairnContestant : public ObservedContestant<bullet::ConstraintSolver> {
 public:
  explicit CairnContestant(const Settings& settings)
      : ObservedContestant<bullet::ConstraintSolver>(settings) {}

  void Begin(const Effort& effort, btContactSolverInfo* info) override;
  Work work() const override;
  std::string refusal() const override;
};

}  // namespace cairn::cli
