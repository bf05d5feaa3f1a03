// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "cairn/contact_problem.h"
#include "cairn/detail/memory.h"
#include "cairn/report.h"
#include "cairn/settings.h"
#include "cycle/block_cycle.h"
#include "pack/block_frame.h"
#include "runtime/budget.h"
#include "runtime/crew.h"
#include "step/island_memories.h"

namespace cairn {

/// Solves contact problems on kernels, in floats, colour by colour, on threads.
class BlockSolver : public detail::Placed {
 public:
  /// @p crew: as the settings of each Solve() say, which it follows already
  explicit BlockSolver(Crew* crew) : crew_(crew) {}

  /// kDone: solved, and the islands of the report are filled in. Otherwise nothing is written: on
  /// kInvalid the input is not valid, on kOutOfRange floats do not do.
  [[nodiscard]] PackResult Solve(const ContactProblem& problem, const Settings& settings,
                                 BudgetMeter* meter, const Impulses& impulses,
                                 std::span<Velocity> velocities, Report* report);
  IslandMemories& memories() { return memories_; }
  /// Some body of the last problem has a Body::strain.
  bool strained() const { return frame_.strained(); }

 private:
  PackResult Begin(const ContactProblem& problem, const Settings& settings,
                   const Impulses& impulses, Crew* crew);

  BlockFrame frame_;
  BlockCycle cycle_;
  IslandMemories memories_;
  Crew* crew_;
  Crew alone_{1};
};

}  // namespace cairn
