// SPDX-License-Identifier: MIT
#pragma once

#include <btBulletDynamicsCommon.h>

#include <string>

#include "measure/instrumented_solver.h"

namespace cairn::cli {

/// Notices when a solver blows up, and stops everything then: a world that goes on with NaN may
/// crash in its collision detection.
class WatchedSolver : public bench::InstrumentedSolver {
 public:
  using InstrumentedSolver::InstrumentedSolver;

  /// Faster is an explosion [m/s]: nothing in the scenes gets to a tenth of it.
  static constexpr btScalar kMostSpeed = 1000;

  /// The world whose bodies are looked at. Not owned.
  void Watch(btDiscreteDynamicsWorld* world) { world_ = world; }
  /// What was noticed; empty if nothing.
  const std::string& failure() const { return failure_; }
  /// Whether that was a position or velocity that is not a finite number.
  bool not_a_number() const { return not_a_number_; }

  void allSolved(const btContactSolverInfo& info, btIDebugDraw* debug_drawer) override;

 private:
  btDiscreteDynamicsWorld* world_ = nullptr;
  std::string failure_;
  bool not_a_number_ = false;
};

}  // namespace cairn::cli
