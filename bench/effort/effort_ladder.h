// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "cairn/contact_problem.h"
#include "contestants/contestant.h"
#include "contestants/solver_registry.h"
#include "measure/substep.h"

namespace cairn::cli {

/// What a solver reached with some effort on a sampled state.
struct CurvePoint {
  double time = 0;   ///< [ms]
  double error = 0;  ///< Velocity error [m/s].
  int iterations = 0, factorisations = 0;
};

/// A solver with more and more to spend: how its error falls with time, on given states.
///
/// Each rung is a solver of its own that has seen the states before with the same effort, as in a
/// run, so that nobody starts cold or from the answer of a richer rung.
class EffortLadder {
 public:
  /// @param most  Time of a substep above which there is no further rung [ms].
  EffortLadder(const SolverChoice& choice, const btContactSolverInfo& defaults, double most);

  /// The state before one that is measured.
  void WarmUp(bench::Substep* substep);
  /// One point per rung, from the least effort on; none of a rung that refused the state.
  std::vector<CurvePoint> Measure(bench::Substep* substep, std::span<const Velocity> truth);

 private:
  struct Rung {
    Effort effort;
    std::unique_ptr<Contestant> contestant;
  };
  /// Time it took [ms].
  double Solve(const Rung& rung, bench::Substep* substep) const;
  void Build(bench::Substep* substep);

  SolverChoice choice_;
  btContactSolverInfo defaults_;
  double most_;
  std::vector<Rung> rungs_;
};

}  // namespace cairn::cli
