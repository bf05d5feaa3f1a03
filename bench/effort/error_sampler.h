// SPDX-License-Identifier: MIT
#pragma once

#include <cairn/bullet/constraint_solver.h>

#include <memory>
#include <span>
#include <vector>

#include "contestants/contestant.h"
#include "contestants/solver_registry.h"
#include "effort/effort_ladder.h"
#include "measure/substep.h"

namespace cairn::cli {

/// Gives the state of a substep to every solver of a run and to the converged reference.
///
/// The solvers are instances of its own, which live as long as it does: they have seen the states
/// of earlier samples, not those of a whole run.
class ErrorSampler {
 public:
  /// @param defaults  settings of a world before any solver changed them.
  ErrorSampler(std::span<const SolverChoice> solvers, const btContactSolverInfo& defaults);

  /// Measures error against time too, up to substeps of so long [ms].
  void AddLadders(std::span<const SolverChoice> solvers, double most);

  /// Lets the solvers solve a state that is not measured, so that they do not start cold.
  void WarmUp(bench::Substep* substep, std::span<const Effort> efforts);

  struct Errors {
    std::vector<double> of_solvers;  ///< [m/s], NaN for a solver that refused the state.
    double reference_residual = 0;   ///< [m/s]
    /// Of each solver, empty without ladders.
    std::vector<std::vector<CurvePoint>> curves;
  };
  /// @param efforts  one per solver
  Errors Measure(bench::Substep* substep, std::span<const Effort> efforts);

 private:
  std::vector<std::unique_ptr<Contestant>> contestants_;
  std::vector<bool> in_parts_;  ///< of each solver: it takes a step in parts
  std::unique_ptr<bullet::ConstraintSolver> reference_;
  btContactSolverInfo defaults_;
  std::vector<std::unique_ptr<EffortLadder>> ladders_;  ///< one for each kind of solver
  std::vector<size_t> ladder_of_;                       ///< of each solver; none without ladders
};

}  // namespace cairn::cli
